// SPDX-License-Identifier: BSD-3-Clause
#include "tests/daemon/schema.hpp"

#include "tests/daemon/text_of.hpp"

#include <gtest/gtest.h>

namespace lilo {
namespace {

using nlohmann::json;

json a_pose() {
  return json::parse(R"({"v":"2.0","timestamp":1.5,"session":"0","seq":0,"pose":{
    "stamp":{"sec":1,"nsec":500000000},"frame_id":"odom","child_frame_id":"velodyne",
    "status":"tracking","position":{"x":0,"y":0,"z":0},"orientation":{"x":0,"y":0,"z":0,"w":1},
    "latency_ms":1.5,"lost_packets":0}})");
}

// The validator itself: it must be able to say no.
TEST(Schema, RefusesWhatTheProtocolForbids) {
  const json schema = protocol_schema();
  EXPECT_EQ(violations(schema, a_pose()), std::vector<std::string>{});
  const auto broken = [&](auto change) {
    json message = a_pose();
    change(message);
    return violations(schema, message).size();
  };
  EXPECT_EQ(broken([](json& m) { m.erase("timestamp"); }), 1U);
  EXPECT_EQ(broken([](json& m) { m["timestamp"] = "1.5"; }), 1U);
  EXPECT_EQ(broken([](json& m) { m["new"] = 1; }), 1U) << "we send no unknown key";
  EXPECT_EQ(broken([](json& m) { m["pose"]["status"] = "fine"; }), 1U);
  EXPECT_EQ(broken([](json& m) { m["pose"]["position"].erase("z"); }), 1U);
  EXPECT_EQ(broken([](json& m) { m["pose"]["covariance"] = json::array({1}); }), 1U);
  EXPECT_EQ(broken([](json& m) { m["pose"]["orientation"]["w"] = 1.1; }), 1U);
  EXPECT_EQ(broken([](json& m) { m["error"] = {{"reason", "x"}}; }), 1U) << "two kinds";
  EXPECT_EQ(broken([](json& m) { m.erase("seq"); }), 1U) << "no kind at all";
}

// A client of version 2.0 that validates must bear version 2.1.
TEST(Schema, AllowsKeysItDoesNotKnow) {
  EXPECT_EQ(protocol_schema().dump().find("additionalProperties"), std::string::npos);
}

// Every name of the schema is in PROTOCOL.md, whole or behind its parent ("`.lost`").
void expect_documented(const json& schema, const std::string& text) {
  if (!schema.contains("properties")) return;
  for (const auto& [name, sub] : schema["properties"].items()) {
    const bool documented = text.find('`' + name + '`') != std::string::npos ||
                            text.find('.' + name + '`') != std::string::npos ||
                            text.find('.' + name + '.') != std::string::npos ||
                            text.find('`' + name + '.') != std::string::npos;
    const bool stage = text.find("stages_ms.*") != std::string::npos && sub.contains("minimum") &&
                       !sub.contains("maximum") && schema["properties"].contains("update_map");
    EXPECT_TRUE(documented || stage) << name;
    expect_documented(sub, text);
  }
}

TEST(Schema, IsWhatTheDocumentSays) {
  expect_documented(protocol_schema(), text_of(LILO_PROTOCOL_FILE));
}

}  // namespace
}  // namespace lilo
