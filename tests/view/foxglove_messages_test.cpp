// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/foxglove_messages.hpp"

#include "tools/bench/base64.hpp"
#include "tools/view/foxglove_session.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

namespace lilo::view {
namespace {

using nlohmann::json;

const std::string kPose =
    R"({"v":"2.0","timestamp":12.5,"session":"s","seq":3,"pose":{"stamp":{"sec":12,"nsec":500000000},
    "frame_id":"odom","child_frame_id":"velodyne","status":"tracking",
    "position":{"x":1,"y":2,"z":3},"orientation":{"x":0,"y":0,"z":0,"w":1}}})";

/// One point at (1, -2, 300.01) m in steps of a centimetre: 100, -200, 30001.
std::string points(int seq, int index, int count) {
  const std::string bytes("\x64\x00\x38\xff\x31\x75", 6);
  return json{{"timestamp", 12.5},
              {"session", "s"},
              {"seq", seq},
              {"points",
               {{"of", "scan"},
                {"index", index},
                {"count", count},
                {"resolution_m", 0.01},
                {"xyz", base64(bytes)}}}}
      .dump();
}

std::vector<float> floats_of(const std::string& data) {
  const std::string bytes = from_base64(data);
  std::vector<float> out(bytes.size() / sizeof(float));
  std::memcpy(out.data(), bytes.data(), out.size() * sizeof(float));
  return out;
}

TEST(Base64, ComesBack) {
  for (const char* text : {"", "f", "fo", "foo", "foobar"})
    EXPECT_EQ(from_base64(base64(text)), text);
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy") << "RFC 4648";
  EXPECT_EQ(from_base64("Zm9v!YmFy"), "foo");
}

TEST(Foxglove, TellsPoseAndTransform) {
  const json pose = json::parse(kPose)["pose"];
  const json in_frame = foxglove_pose(pose);
  EXPECT_EQ(in_frame["timestamp"]["nsec"], 500000000);
  EXPECT_EQ(in_frame["frame_id"], "odom");
  EXPECT_EQ(in_frame["pose"]["position"]["z"], 3);
  const json transform = foxglove_transforms(pose)["transforms"][0];
  EXPECT_EQ(transform["child_frame_id"], "velodyne");
  EXPECT_EQ(transform["translation"], pose["position"]);
  EXPECT_EQ(transform["rotation"], pose["orientation"]);
}

TEST(Foxglove, GathersTheCloudOfAScan) {
  FoxglovePoints gathered;
  EXPECT_FALSE(gathered.add(json::parse(points(3, 0, 2))));
  EXPECT_TRUE(gathered.add(json::parse(points(3, 1, 2))));
  const json cloud = gathered.cloud({{"sec", 1}, {"nsec", 2}}, "velodyne");
  EXPECT_EQ(cloud["frame_id"], "velodyne");
  const std::vector<float> xyz_m = floats_of(cloud["data"]);
  ASSERT_EQ(xyz_m.size(), 6U);
  EXPECT_NEAR(xyz_m[0], 1.0, 1e-5);
  EXPECT_NEAR(xyz_m[4], -2.0, 1e-5);
  EXPECT_NEAR(xyz_m[5], 300.01, 1e-3);
  EXPECT_TRUE(gathered.add(json::parse(points(4, 0, 1)))) << "another scan begins anew";
  EXPECT_EQ(floats_of(gathered.cloud({}, "velodyne")["data"]).size(), 3U);
}

// Opcode 1, subscription and time little-endian, then the payload.
TEST(Foxglove, MessagesHaveTheirBinaryForm) {
  const std::string message = foxglove_message(0x01020304, 0x1122334455667788, "{}");
  EXPECT_EQ(message, std::string("\x01\x04\x03\x02\x01\x88\x77\x66\x55\x44\x33\x22\x11{}", 15));
}

TEST(Foxglove, SessionSendsWhatIsSubscribed) {
  StreamLog log(1U << 20U);
  log.add(LineKind::pose, kPose);
  FoxgloveSession session(log);
  std::string message;
  bool is_binary = true;
  ASSERT_TRUE(session.next(message, is_binary));
  EXPECT_EQ(json::parse(message)["op"], "serverInfo");
  ASSERT_TRUE(session.next(message, is_binary));
  EXPECT_EQ(json::parse(message)["op"], "advertise");
  EXPECT_FALSE(is_binary);
  EXPECT_FALSE(session.next(message, is_binary)) << "nothing is subscribed";
  session.take(R"({"op":"subscribe","subscriptions":[{"id":7,"channelId":3}]})");
  for (const char* nonsense : {"", "[]", "{}", R"({"op":5})", R"({"op":"subscribe"})",
                               R"({"op":"subscribe","subscriptions":[{"id":"x"}]})"})
    session.take(nonsense);
  log.add(LineKind::pose, kPose);
  log.add(LineKind::points, points(3, 0, 1));
  ASSERT_TRUE(session.next(message, is_binary));
  EXPECT_TRUE(is_binary);
  EXPECT_EQ(message[1], 7);
  EXPECT_EQ(json::parse(message.substr(13))["point_stride"], 12);
  EXPECT_FALSE(session.next(message, is_binary));
  session.take(R"({"op":"unsubscribe","subscriptionIds":[7]})");
  log.add(LineKind::pose, kPose);
  EXPECT_FALSE(session.next(message, is_binary));
}

TEST(Foxglove, AgreesOnAProtocolItSpeaks) {
  EXPECT_EQ(foxglove_protocol("foxglove.websocket.v1"), "foxglove.websocket.v1");
  EXPECT_EQ(foxglove_protocol("foxglove.sdk.v1, foxglove.websocket.v1"), "foxglove.sdk.v1");
  EXPECT_EQ(foxglove_protocol("chat"), "");
}

}  // namespace
}  // namespace lilo::view
