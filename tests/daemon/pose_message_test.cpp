// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pose_message.hpp"

#include "tests/daemon/schema.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace lilo {
namespace {

using nlohmann::json;

const PoseMessageContext kContext{"0123456789abcdef", "odom", "velodyne"};

PoseReport a_report() {
  PoseReport report;
  report.seq = 17;
  report.last_packet_ns = 5'000'000;
  report.packets.lost = 3;
  Estimate& e = report.estimate;
  e.stamp_ns = 1'453'364'282'709'000'001;
  e.T_odom_sensor = {so3_exp({0.1, -0.2, 2.5}), {1234.56789012, -0.00000049, 3.0}};
  e.twist = {.linear_mps = {1.5, 0.25, -0.125}, .angular_radps = {0.0, 0.0, 0.5}};
  e.status = TrackingStatus::tracking;
  e.covariance = Matrix6d::Identity() * 1e-4;
  e.covariance(0, 5) = -2.5e-6;
  e.has_covariance = true;
  return report;
}

json message_of(const PoseReport& report) {
  JsonWriter out;
  return json::parse(write_pose(kContext, report, 11'100'000, out));
}

TEST(PoseMessage, HoldsEveryField) {
  const json m = message_of(a_report());
  EXPECT_EQ(m["v"], "2.0");
  EXPECT_TRUE(m["timestamp"].is_number());
  EXPECT_NEAR(m["timestamp"].get<double>(), 1453364282.709, 1e-6);
  EXPECT_EQ(m["session"], "0123456789abcdef");
  EXPECT_EQ(m["seq"], 17);
  const json& pose = m["pose"];
  EXPECT_EQ(pose["stamp"]["sec"], 1453364282);
  EXPECT_EQ(pose["stamp"]["nsec"], 709000001);
  EXPECT_EQ(pose["frame_id"], "odom");
  EXPECT_EQ(pose["child_frame_id"], "velodyne");
  EXPECT_EQ(pose["status"], "tracking");
  EXPECT_EQ(pose["twist"]["linear"]["x"], 1.5);
  EXPECT_EQ(pose["twist"]["angular"]["z"], 0.5);
  ASSERT_EQ(pose["covariance"].size(), 36U);
  EXPECT_DOUBLE_EQ(pose["covariance"][0].get<double>(), 1e-4);
  EXPECT_DOUBLE_EQ(pose["covariance"][5].get<double>(), -2.5e-6) << "row-major";
  EXPECT_DOUBLE_EQ(pose["latency_ms"].get<double>(), 6.1);
  EXPECT_EQ(pose["lost_packets"], 3);
}

// The acceptance is 1e-6 m and 1e-6 rad end to end; the wire may take a tenth of it.
TEST(PoseMessage, CarriesThePoseToATenthOfAMicrometre) {
  std::mt19937 rng(2);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int k = 0; k < 1000; ++k) {
    PoseReport report = a_report();
    Pose& pose = report.estimate.T_odom_sensor;
    pose = {so3_exp(3.0 * Eigen::Vector3d(u(rng), u(rng), u(rng))),
            1e5 * Eigen::Vector3d(u(rng), u(rng), u(rng))};
    const json m = message_of(report);
    const json& p = m["pose"]["position"];
    const json& q = m["pose"]["orientation"];
    const Eigen::Vector3d read(p["x"].get<double>(), p["y"].get<double>(), p["z"].get<double>());
    const Eigen::Quaterniond turn(q["w"].get<double>(), q["x"].get<double>(), q["y"].get<double>(),
                                  q["z"].get<double>());
    EXPECT_LT((read - pose.translation_m).norm(), 1e-7);
    EXPECT_LT(so3_log(turn.normalized() * pose.rotation.conjugate()).norm(), 1e-7);
  }
}

// Other fusers took a velocity of zero, and a covariance of zero, for measurements.
TEST(PoseMessage, LeavesOutWhatIsNotKnown) {
  PoseReport report = a_report();
  report.estimate.has_covariance = false;
  EXPECT_FALSE(message_of(report)["pose"].contains("covariance"));
  for (const auto status : {TrackingStatus::initializing, TrackingStatus::lost}) {
    report.estimate.status = status;
    const json m = message_of(report);
    EXPECT_EQ(m["pose"]["status"], to_string(status));
    EXPECT_FALSE(m["pose"].contains("twist"));
    EXPECT_TRUE(m["pose"].contains("position")) << "it keeps sending while lost";
  }
}

Estimate weak_along(const std::vector<Vector6d>& directions) {
  Estimate e = a_report().estimate;
  e.status = TrackingStatus::degraded;
  for (const Vector6d& direction : directions)
    e.weak_directions[static_cast<std::size_t>(e.weak_count++)] = {direction, 0.0626};
  return e;
}

// A corridor: nothing says how far one went along it, and little how far one turned about it.
TEST(PoseMessage, NamesWeakDirections) {
  PoseReport report = a_report();
  EXPECT_FALSE(message_of(report)["pose"].contains("weak_directions"));
  report.estimate = weak_along({Vector6d::Unit(0), -Vector6d::Unit(3)});
  const json m = message_of(report);
  EXPECT_EQ(violations(protocol_schema(), m), std::vector<std::string>{}) << m;
  const json& weak = m["pose"]["weak_directions"];
  ASSERT_EQ(weak.size(), 2U);
  EXPECT_EQ(weak[0]["direction"], json({1, 0, 0, 0, 0, 0}));
  EXPECT_EQ(weak[1]["direction"][3], -1);
  EXPECT_DOUBLE_EQ(weak[0]["from_scan"].get<double>(), 0.063) << "three decimals";
  EXPECT_TRUE(m["pose"].contains("covariance")) << "there is room for both";
}

// Where to trust the pose is worth more than its variance.
TEST(PoseMessage, WeakDirectionsOutlastTheCovariance) {
  PoseReport report = a_report();
  const Vector6d mixed = Vector6d::Constant(-1.0).normalized();
  report.estimate = weak_along({mixed, mixed, mixed, mixed, mixed, mixed});
  report.estimate.covariance = Matrix6d::Constant(-1.2345e-101);
  const json m = message_of(report);
  EXPECT_EQ(violations(protocol_schema(), m), std::vector<std::string>{}) << m;
  EXPECT_EQ(m["pose"]["weak_directions"].size(), 6U);
  EXPECT_FALSE(m["pose"].contains("covariance"));
  report.estimate.weak_directions[5].from_scan = std::nan("");
  EXPECT_FALSE(message_of(report)["pose"].contains("weak_directions"));
}

TEST(PoseMessage, NothingThatIsNotFiniteIsSent) {
  PoseReport report = a_report();
  report.estimate.covariance(3, 3) = std::nan("");
  report.estimate.twist.linear_mps.y() = HUGE_VAL;
  const json m = message_of(report);
  EXPECT_FALSE(m["pose"].contains("covariance"));
  EXPECT_FALSE(m["pose"].contains("twist"));

  JsonWriter out;
  report.estimate.T_odom_sensor.translation_m.z() = std::nan("");
  EXPECT_TRUE(write_pose(kContext, report, 0, out).empty());
  report = a_report();
  report.estimate.T_odom_sensor.rotation.w() = HUGE_VAL;
  EXPECT_TRUE(write_pose(kContext, report, 0, out).empty());
}

// The longest names the configuration allows and the widest numbers: the covariance has to go.
TEST(PoseMessage, NeverOutgrowsTheDatagram) {
  const PoseMessageContext wide{"0123456789abcdef", std::string(64, 'a'), std::string(64, 'b')};
  PoseReport report = a_report();
  report.seq = ~std::uint64_t{0};
  report.estimate.covariance = Matrix6d::Constant(-1.2345678e-101);
  report.estimate.T_odom_sensor.translation_m = Eigen::Vector3d::Constant(-123456789.0123456);
  report.estimate.twist.linear_mps = Eigen::Vector3d::Constant(-12345.678901);
  report.estimate.twist.angular_radps = Eigen::Vector3d::Constant(-12345.678901);
  JsonWriter out;
  const std::string_view text = write_pose(wide, report, 0, out);
  EXPECT_LE(text.size(), 1200U);
  const json m = json::parse(text);
  EXPECT_EQ(m["pose"]["child_frame_id"], wide.child_frame_id);
}

// PlotJuggler reads the stamp as a top-level number and flattens the rest; one datagram that breaks
// either rule switches its time stamps off or closes its server.
TEST(PoseMessage, SuitsPlotJuggler) {
  const json m = message_of(a_report());
  EXPECT_TRUE(m.is_object());
  EXPECT_TRUE(m["timestamp"].is_number_float());
  const json flat = m.flatten();
  for (const char* series :
       {"/pose/position/x", "/pose/orientation/w", "/pose/latency_ms", "/pose/covariance/35"}) {
    EXPECT_TRUE(flat.contains(series)) << series;
  }
  for (const auto& [path, value] : flat.items()) EXPECT_FALSE(value.is_null()) << path;
}

TEST(Session, IsNewEveryTime) {
  const std::string a = new_session(), b = new_session();
  EXPECT_EQ(a.size(), 16U);
  EXPECT_NE(a, b);
}

}  // namespace
}  // namespace lilo
