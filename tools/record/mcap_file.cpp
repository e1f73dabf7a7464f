// SPDX-License-Identifier: BSD-3-Clause
#include "tools/record/mcap_file.hpp"

#include "tools/message_numbers.hpp"
#include "tools/record/mcap_schemas.hpp"

#include <nlohmann/json.hpp>

namespace lilo {
namespace {

using nlohmann::json;

std::int64_t stamp_ns(const json& message) {
  if (message.contains("pose")) return stamp_ns_from(message["pose"].at("stamp"));
  return message.contains("timestamp") ? timestamp_ns_from(message["timestamp"]) : 0;
}

bool is_valid(const json& pose) {
  const std::string status = pose.value("status", "");
  return status == "tracking" || status == "degraded";
}

json pose_in_frame(const json& pose) {
  return {{"timestamp", pose.at("stamp")},
          {"frame_id", pose.at("frame_id")},
          {"pose", {{"position", pose.at("position")}, {"orientation", pose.at("orientation")}}}};
}

json frame_transform(const json& pose) {
  return {{"timestamp", pose.at("stamp")},
          {"parent_frame_id", pose.at("frame_id")},
          {"child_frame_id", pose.at("child_frame_id")},
          {"translation", pose.at("position")},
          {"rotation", pose.at("orientation")}};
}

}  // namespace

McapFile::McapFile(const std::string& path)
    : writer_(path),
      pose_(writer_.add_channel("/lilod/pose",
                                writer_.add_schema("lilod.Pose", datagram_schema("pose")))),
      health_(writer_.add_channel("/lilod/health",
                                  writer_.add_schema("lilod.Health", datagram_schema("health")))),
      odom_(writer_.add_channel(
          "/odom", writer_.add_schema("foxglove.PoseInFrame", pose_in_frame_schema()))),
      transform_(writer_.add_channel(
          "/tf", writer_.add_schema("foxglove.FrameTransform", frame_transform_schema()))) {}

void McapFile::take(std::string_view datagram, const json& message, std::int64_t received_ns) {
  if (message.contains("health"))
    writer_.write(health_, 0, received_ns, stamp_ns(message), datagram);
  if (!message.contains("pose")) return;
  const json& pose = message["pose"];
  const std::int64_t published_ns = stamp_ns(message);
  const auto seq = static_cast<std::uint32_t>(count_in(message, "seq"));
  writer_.write(pose_, seq, received_ns, published_ns, datagram);
  if (!is_valid(pose)) return;
  writer_.write(odom_, seq, received_ns, published_ns, pose_in_frame(pose).dump());
  writer_.write(transform_, seq, received_ns, published_ns, frame_transform(pose).dump());
}

}  // namespace lilo
