// SPDX-License-Identifier: BSD-3-Clause
#include "tools/listen/pose_message.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace lilo {
namespace {

constexpr const char* kDatagram =
    R"({"timestamp":1715678102.249522,"seq":17,"session":"6f","pose":{)"
    R"("stamp":{"sec":1715678102,"nsec":249522001},"frame_id":"odom","child_frame_id":"velodyne",)"
    R"("status":"tracking","position":{"x":1.5,"y":-2.25,"z":0.125},)"
    R"("orientation":{"x":0,"y":0,"z":0.7071067811865476,"w":0.7071067811865476},)"
    R"("some_later_addition":[1,2,3]}})";

TEST(PoseMessage, IsReadFromTheProtocolsJson) {
  PoseMessage message;
  ASSERT_EQ(parse_message(kDatagram, message), MessageKind::pose);
  EXPECT_EQ(message.seq, 17U);
  EXPECT_EQ(message.session, "6f");
  EXPECT_EQ(message.status, "tracking");
  EXPECT_EQ(message.pose.stamp_ns, 1715678102249522001);
  EXPECT_EQ(message.pose.pose.translation_m, Eigen::Vector3d(1.5, -2.25, 0.125));
  const Eigen::Vector3d turned = message.pose.pose.rotation * Eigen::Vector3d::UnitX();
  EXPECT_LT((turned - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_FALSE(message.deviation) << "it was not said, so it is not zero";
  EXPECT_TRUE(message.weak.empty());
}

// Variances 0.01, 0.02, 0.06 m^2: 0.3 m; of rotation 0, 0 and (1 deg)^2. Weak along y, then yaw.
TEST(PoseMessage, DeviationAndWeakDirectionsAreShown) {
  std::string covariance = "0.01,0,0,0,0,0, 0,0.02,0,0,0,0, 0,0,0.06,0,0,0, 0,0,0,0,0,0,";
  covariance += "0,0,0,0,0,0, 0,0,0,0,0,0.00030461741978670857";
  const std::string more =
      R"("covariance":[)" + covariance +
      R"(],"weak_directions":[{"direction":[0.1,-0.995,0,0,0,0],"from_scan":0.03},)"
      R"({"direction":[0,0,0,0,0,1],"from_scan":0.4}],"some_later_addition")";
  std::string datagram = kDatagram;
  const std::string place = R"("some_later_addition")";
  datagram.replace(datagram.find(place), place.size(), more);
  PoseMessage message;
  ASSERT_EQ(parse_message(datagram, message), MessageKind::pose);
  ASSERT_TRUE(message.deviation);
  EXPECT_NEAR(message.deviation->position_m, 0.3, 1e-12);
  const std::string line = pose_line(message);
  for (const char* part : {" 0.300 ", " 1.000 ", "weak: y 3 %, rz 40 %\n"}) {
    EXPECT_NE(line.find(part), std::string::npos) << part << " in " << line;
  }
}

TEST(PoseMessage, LineShowsTimeOfDayAndAngles) {
  PoseMessage message;
  ASSERT_EQ(parse_message(kDatagram, message), MessageKind::pose);
  const std::string line = pose_line(message);
  for (const char* part : {"09:15:02.249522", " 17 ", "tracking", "1.500", "-2.250", "90.000"}) {
    EXPECT_NE(line.find(part), std::string::npos) << part << " in " << line;
  }
}

TEST(PoseMessage, LineNeverShowsMinusZero) {
  PoseMessage message;
  message.pose.pose.translation_m = {-1e-5, -0.0, -4e-4};
  EXPECT_EQ(pose_line(message).find("-0"), std::string::npos) << pose_line(message);
}

TEST(PoseMessage, HealthIsOneShortLineAndTheUnknownIsShownAsItIs) {
  const std::string line = other_line(
      R"({"timestamp":1.0,"health":{"status":"tracking","complaints":["sensor hot"],"rate_hz":10,)"
      R"("packets":{"received":754,"lost":3},"scans":{"dropped":2},)"
      R"("latency_ms":{"p50":6.04,"p99":9.96,"max":20}}})");
  for (const char* part : {"tracking", "10 Hz", "754 packets", "3 lost", "2 scans dropped",
                           "6.0 ms", "p99 10.0 ms", "sensor hot"}) {
    EXPECT_NE(line.find(part), std::string::npos) << part << " in " << line;
  }
  EXPECT_EQ(other_line(R"({"hello":1})"), "{\"hello\":1}\n");
  EXPECT_EQ(other_line(R"({"health":{}})"), "{\"health\":{}}\n");
}

TEST(PoseMessage, OtherObjectsAreNotPosesAndRubbishIsNoMessage) {
  PoseMessage message;
  EXPECT_EQ(parse_message(R"({"timestamp":1.0,"health":{}})", message), MessageKind::other);
  for (const char* bad : {"", "{", "17", "[]", R"({"seq":1,"pose":{}})", R"({"seq":1,"pose":3})",
                          "\xff\xfe", R"({"seq":"x","pose":{"position":{}}})"}) {
    EXPECT_EQ(parse_message(bad, message), MessageKind::malformed) << bad;
  }
  const std::string sec = R"("sec":1715678102)", seq = R"("seq":17)";
  for (const auto& [good, bad] : {std::pair{sec, R"("sec":9000000001)"},
                                  {sec, R"("sec":-1)"},
                                  {sec, R"("sec":1e30)"},
                                  {seq, R"("seq":-1)"},
                                  {seq, R"("seq":1.5)"},
                                  {seq, R"("seq":1e30)"}}) {
    std::string datagram = kDatagram;
    datagram.replace(datagram.find(good), good.size(), bad);
    EXPECT_EQ(parse_message(datagram, message), MessageKind::malformed) << bad;
  }
}

// The major number is what counts; its names may mean other things.
TEST(PoseMessage, OfAnotherProtocolIsNotUnderstood) {
  PoseMessage message;
  const auto kind_of = [&](const std::string& version) {
    return parse_message("{\"v\":" + version + ',' + std::string(kDatagram).substr(1), message);
  };
  EXPECT_EQ(kind_of(R"("2.0")"), MessageKind::pose);
  EXPECT_EQ(kind_of(R"("2.9")"), MessageKind::pose);
  for (const char* other : {R"("1.0")", R"("3.0")", R"("20.0")", R"("")", "2.0", "null"})
    EXPECT_EQ(kind_of(other), MessageKind::other_version) << other;
}

// Anybody may send to the port that `lilo listen` has.
TEST(PoseMessage, NothingThatATerminalObeysIsShown) {
  std::string datagram = kDatagram;
  datagram.replace(datagram.find("tracking"), 8, R"(\u001b[2Jx\u009b)");
  PoseMessage message;
  ASSERT_EQ(parse_message(datagram, message), MessageKind::pose);
  for (const std::string& line :
       {pose_line(message), other_line("{\"a\":\"\xc2\x9b\"}"),
        other_line(R"({"health":{"status":"\u001b[2J","complaints":["\u009b"],"rate_hz":1,)"
                   R"("packets":{"received":1,"lost":0},"scans":{"dropped":0},)"
                   R"("latency_ms":{"p50":1,"p99":1}}})")}) {
    EXPECT_EQ(line.find('\x1b'), std::string::npos) << line;
    EXPECT_EQ(line.find("\xc2\x9b"), std::string::npos) << line;
    EXPECT_NE(line.find('?'), std::string::npos) << line;
  }
}

}  // namespace
}  // namespace lilo
