// SPDX-License-Identifier: BSD-3-Clause
#include "tools/record/mcap_schemas.hpp"

#include <nlohmann/json.hpp>

namespace lilo {
namespace {

using nlohmann::json;

/// "#/$defs/vector" of the same file becomes what it names.
json without_references(const json& schema, const json& root) {
  if (schema.is_object() && schema.contains("$ref")) {
    const std::string pointer = schema["$ref"].get<std::string>().substr(1);
    return without_references(root.at(json::json_pointer(pointer)), root);
  }
  if (!schema.is_structured()) return schema;
  json out = schema;
  for (json& inner : out) inner = without_references(inner, root);
  return out;
}

json numbers(std::initializer_list<const char*> names) {
  json properties = json::object();
  for (const char* name : names) properties[name] = {{"type", "number"}};
  return {{"type", "object"}, {"properties", properties}};
}

json object_of(const json& properties, const char* title) {
  return {{"title", title}, {"type", "object"}, {"properties", properties}};
}

json time() {
  const json integer{{"type", "integer"}, {"minimum", 0}};
  return {
      {"type", "object"}, {"title", "time"}, {"properties", {{"sec", integer}, {"nsec", integer}}}};
}

json text() { return {{"type", "string"}}; }

}  // namespace

std::string datagram_schema(const std::string& kind) {
  const json root = json::parse(kProtocolSchema);
  json properties = json::object();
  for (const std::string name : {"v", "timestamp", "session", "seq"}) {
    if (name != "seq" || kind == "pose")
      properties[name] = without_references(root["properties"][name], root);
  }
  properties[kind] = without_references(root["properties"][kind], root);
  json schema = object_of(properties, ("lilod " + kind).c_str());
  schema["required"] = {"v", "timestamp", "session", kind};
  return schema.dump();
}

std::string pose_in_frame_schema() {
  const json pose{
      {"type", "object"},
      {"properties",
       {{"position", numbers({"x", "y", "z"})}, {"orientation", numbers({"x", "y", "z", "w"})}}}};
  return object_of({{"timestamp", time()}, {"frame_id", text()}, {"pose", pose}},
                   "foxglove.PoseInFrame")
      .dump();
}

std::string frame_transform_schema() {
  return object_of({{"timestamp", time()},
                    {"parent_frame_id", text()},
                    {"child_frame_id", text()},
                    {"translation", numbers({"x", "y", "z"})},
                    {"rotation", numbers({"x", "y", "z", "w"})}},
                   "foxglove.FrameTransform")
      .dump();
}

}  // namespace lilo
