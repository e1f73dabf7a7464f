// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/foxglove_messages.hpp"

#include "tools/bench/base64.hpp"
#include "tools/message_numbers.hpp"

#include <bit>
#include <utility>

namespace lilo::view {
namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "as the protocol's numbers are");

json object_of(json properties) {
  return {{"type", "object"}, {"properties", std::move(properties)}};
}

json numbers(std::initializer_list<const char*> names) {
  json properties;
  for (const char* name : names) properties[name] = {{"type", "number"}};
  return object_of(std::move(properties));
}

json time_schema() {
  json time = object_of({{"sec", {{"type", "integer"}}}, {"nsec", {{"type", "integer"}}}});
  time["title"] = "time";
  return time;
}

json text_schema() { return {{"type", "string"}}; }

json pose_schema() {
  return object_of(
      {{"position", numbers({"x", "y", "z"})}, {"orientation", numbers({"x", "y", "z", "w"})}});
}

json cloud_schema() {
  const json field = object_of({{"name", text_schema()},
                                {"offset", {{"type", "integer"}}},
                                {"type", {{"type", "integer"}}}});
  return object_of({{"timestamp", time_schema()},
                    {"frame_id", text_schema()},
                    {"pose", pose_schema()},
                    {"point_stride", {{"type", "integer"}}},
                    {"fields", {{"type", "array"}, {"items", field}}},
                    {"data", {{"type", "string"}, {"contentEncoding", "base64"}}}});
}

json transforms_schema() {
  const json transform = object_of({{"timestamp", time_schema()},
                                    {"parent_frame_id", text_schema()},
                                    {"child_frame_id", text_schema()},
                                    {"translation", numbers({"x", "y", "z"})},
                                    {"rotation", numbers({"x", "y", "z", "w"})}});
  return object_of({{"transforms", {{"type", "array"}, {"items", transform}}}});
}

json channel(FoxgloveChannel id, const char* topic, const char* schema_name, const json& schema) {
  return {{"id", static_cast<std::uint32_t>(id)},
          {"topic", topic},
          {"encoding", "json"},
          {"schemaName", schema_name},
          {"schema", schema.dump()},
          {"schemaEncoding", "jsonschema"}};
}

void append_points(const json& points, std::vector<float>& xyz_m) {
  const std::string bytes = from_base64(points.at("xyz").get_ref<const std::string&>());
  const auto step_m = points.at("resolution_m").get<float>();
  for (std::size_t k = 0; k + 2 <= bytes.size(); k += 2) {
    const auto low = static_cast<std::uint8_t>(bytes[k]);
    const auto high = static_cast<std::uint8_t>(bytes[k + 1]);
    const auto steps = static_cast<std::int16_t>(low | high << 8U);
    xyz_m.push_back(step_m * static_cast<float>(steps));
  }
}

}  // namespace

std::string foxglove_advertisement() {
  using Channel = FoxgloveChannel;
  const json pose = object_of(
      {{"timestamp", time_schema()}, {"frame_id", text_schema()}, {"pose", pose_schema()}});
  const json any = object_of(json::object());
  return json{
      {"op", "advertise"},
      {"channels",
       {channel(Channel::pose, "/pose", "foxglove.PoseInFrame", pose),
        channel(Channel::transforms, "/tf", "foxglove.FrameTransforms", transforms_schema()),
        channel(Channel::scan, "/scan", "foxglove.PointCloud", cloud_schema()),
        channel(Channel::map, "/map", "foxglove.PointCloud", cloud_schema()),
        channel(Channel::health, "/health", "lilo.Health", any),
        channel(Channel::datagram, "/lilo_pose", "lilo.Pose", any)}}}
      .dump();
}

json foxglove_pose(const json& pose) {
  return {{"timestamp", pose.at("stamp")},
          {"frame_id", pose.at("frame_id")},
          {"pose", {{"position", pose.at("position")}, {"orientation", pose.at("orientation")}}}};
}

json foxglove_transforms(const json& pose) {
  const json transform{{"timestamp", pose.at("stamp")},
                       {"parent_frame_id", pose.at("frame_id")},
                       {"child_frame_id", pose.at("child_frame_id")},
                       {"translation", pose.at("position")},
                       {"rotation", pose.at("orientation")}};
  return {{"transforms", json::array({transform})}};
}

bool FoxglovePoints::add(const json& message) {
  const json& points = message.at("points");
  const auto index = count_from(points.at("index"));
  const auto seq = count_from(message.at("seq"));
  if (seq != seq_ || index == 0) xyz_m_.clear();
  seq_ = seq;
  append_points(points, xyz_m_);
  return index + 1 == count_from(points.at("count"));
}

json FoxglovePoints::cloud(const json& stamp, const json& frame_id) const {
  constexpr int kFloat32 = 7;
  json fields = json::array();
  for (const auto& [name, offset] : {std::pair{"x", 0}, std::pair{"y", 4}, std::pair{"z", 8}})
    fields.push_back({{"name", name}, {"offset", offset}, {"type", kFloat32}});
  const std::string_view bytes(reinterpret_cast<const char*>(xyz_m_.data()),
                               xyz_m_.size() * sizeof(float));
  return {{"timestamp", stamp},
          {"frame_id", frame_id},
          {"pose",
           {{"position", {{"x", 0}, {"y", 0}, {"z", 0}}},
            {"orientation", {{"x", 0}, {"y", 0}, {"z", 0}, {"w", 1}}}}},
          {"point_stride", 12},
          {"fields", fields},
          {"data", base64(bytes)}};
}

std::string foxglove_message(std::uint32_t subscription, std::int64_t stamp_ns,
                             std::string_view payload) {
  constexpr char kMessageData = 1;
  std::string out(1, kMessageData);
  const auto append = [&](std::uint64_t value, int bytes) {
    for (int k = 0; k < bytes; ++k) out += static_cast<char>(value >> (8 * k) & 0xFFU);
  };
  append(subscription, 4);
  append(static_cast<std::uint64_t>(stamp_ns), 8);
  return out += payload;
}

}  // namespace lilo::view
