// SPDX-License-Identifier: BSD-3-Clause
#include "tools/run/pose_log.hpp"

#include "tests/daemon/schema.hpp"
#include "tests/tools/temporary_file.hpp"
#include "tools/eval/pose_stream.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <sstream>

namespace lilo {
namespace {

Estimate estimate_of(int k, std::uint32_t restarts) {
  Estimate estimate;
  estimate.stamp_ns = 1'000'000'000LL * (k + 1);
  estimate.T_odom_sensor.translation_m = {1.0 * k, 0, 0};
  estimate.status = TrackingStatus::tracking;
  estimate.covariance = 1e-4 * Matrix6d::Identity();
  estimate.has_covariance = true;
  estimate.restarts = restarts;
  return estimate;
}

std::vector<nlohmann::json> lines_of(const TemporaryFile& file) {
  std::vector<nlohmann::json> lines;
  std::istringstream text(file.text());
  for (std::string line; std::getline(text, line);) lines.push_back(nlohmann::json::parse(line));
  return lines;
}

TEST(PoseLog, EveryLineIsADatagramOfTheProtocol) {
  const TemporaryFile file;
  PoseLog log(file.path(), {.child_frame_id = "mast"});
  Scan scan;
  scan.packets.lost = 3;
  for (int k = 0; k < 3; ++k) log.add(scan, estimate_of(k, 0));
  log.finish();
  const auto lines = lines_of(file);
  ASSERT_EQ(lines.size(), 3U);
  for (const nlohmann::json& line : lines) {
    EXPECT_EQ(violations(protocol_schema(), line), std::vector<std::string>{});
  }
  EXPECT_EQ(lines[2]["pose"]["child_frame_id"], "mast");
  EXPECT_EQ(lines[2]["pose"]["lost_packets"], 3);
  EXPECT_EQ(lines[2]["pose"]["covariance"][7], 1e-4);
}

// PROTOCOL.md: seq counts the poses of the session from 0; a lost map given up is a new session.
TEST(PoseLog, AnotherMapIsAnotherSession) {
  const TemporaryFile file;
  PoseLog log(file.path(), {});
  for (int k = 0; k < 5; ++k) log.add({}, estimate_of(k, k < 3 ? 0 : 1));
  log.finish();
  const auto lines = lines_of(file);
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_EQ(lines[2]["session"], lines[0]["session"]);
  EXPECT_NE(lines[3]["session"], lines[2]["session"]);
  EXPECT_EQ(lines[4]["session"], lines[3]["session"]);
  EXPECT_EQ(lines[2]["seq"], 2);
  EXPECT_EQ(lines[3]["seq"], 0);
  EXPECT_EQ(lines[4]["seq"], 1);
  const PoseStream stream = read_pose_stream(file.path());
  EXPECT_EQ(stream.poses[2].session, 0);
  EXPECT_EQ(stream.poses[3].session, 1);
}

// A sensor that looks to the left drives along its -y when the robot drives ahead.
TEST(PoseLog, PosesAreThoseOfTheRobotsFrame) {
  const TemporaryFile file;
  PoseLog log(file.path(), {.T_base_sensor = {.yaw_rad = std::numbers::pi / 2}});
  Estimate estimate = estimate_of(0, 0);
  estimate.T_odom_sensor.translation_m = {0.0, -2.0, 0.0};
  log.add({}, estimate);
  log.finish();
  const Pose pose = read_pose_stream(file.path()).poses.at(0).pose.pose;
  EXPECT_LT((pose.translation_m - Eigen::Vector3d(2.0, 0.0, 0.0)).norm(), 1e-6);
}

}  // namespace
}  // namespace lilo
