// SPDX-License-Identifier: BSD-3-Clause
#include "core/odometry.hpp"
#include "tests/core/analytic_scene.hpp"

#include <gtest/gtest.h>

namespace lilo::paper {
namespace {

const BeamTable k16 = test::even_beams(16, -15.0, 15.0);

OdometryConfig config_16() {
  OdometryConfig config;
  config.profile = Profile::paper;
  return config;
}

Scan second_scan(const test::Scene& scene, const Pose& T) {
  Scan scan = test::still_scan_of(scene, k16, T);
  scan.index = 1;
  scan.motion_compensated = true;
  scan.start_ns += 100'000'000;
  scan.end_ns += 100'000'000;
  return scan;
}

TEST(PaperOdometry, RecoversAKnownStepBetweenTwoScans) {
  const Pose step{so3_exp({0.01, -0.015, 0.05}), {0.4, -0.1, 0.05}};
  Odometry odometry(config_16());
  odometry.process(test::still_scan_of(test::yard(), k16, {}));
  const Estimate e = odometry.process(second_scan(test::yard(), step));
  const Pose error = step.inverse() * e.T_odom_sensor;
  EXPECT_LT(error.translation_m.norm(), 0.02);
  EXPECT_LT(so3_log(error.rotation).norm(), 0.002);
}

/// The yard as seen by a world whose axes are turned by `yaw_rad` about z.
test::Scene turned(test::Scene scene, double yaw_rad) {
  const Eigen::Quaterniond R = so3_exp({0.0, 0.0, yaw_rad});
  for (test::Plane& plane : scene.planes) plane.normal = R * plane.normal;
  for (test::Pole& pole : scene.poles) {
    const Eigen::Vector3d at = R * Eigen::Vector3d(pole.x_m, pole.y_m, 0.0);
    pole.x_m = at.x();
    pole.y_m = at.y();
  }
  return scene;
}

TEST(PaperOdometry, RotatingTheProblemRotatesTheAnswer) {
  const Pose step{so3_exp({0.01, -0.015, 0.05}), {0.4, -0.1, 0.05}};
  for (const double yaw_rad : {0.0, 0.7, -2.1}) {
    const Pose turn{so3_exp({0.0, 0.0, yaw_rad}), Eigen::Vector3d::Zero()};
    const Pose expected = turn * step * turn.inverse();
    const test::Scene scene = turned(test::yard(), yaw_rad);
    Odometry odometry(config_16());
    odometry.process(test::still_scan_of(scene, k16, {}));
    const Pose found = odometry.process(second_scan(scene, expected)).T_odom_sensor;
    const Pose error = expected.inverse() * found;
    EXPECT_LT(error.translation_m.norm(), 0.03) << yaw_rad;
    EXPECT_LT(so3_log(error.rotation).norm(), 0.003) << yaw_rad;
  }
}

/// Error of the last pose after two seconds of speeding up to `speed_mps` and turning.
double final_error_m(double speed_mps, Deskew deskew, bool motion_compensated = false) {
  const auto pose_at = [&](double t_s) {
    const double x_m = 0.25 * speed_mps * t_s * t_s;
    return Pose{so3_exp({0.0, 0.0, 0.05 * t_s * t_s}), {x_m - 8.0, 0.1 * x_m, 0.0}};
  };
  OdometryConfig config = config_16();
  config.paper.deskew = deskew;
  Odometry odometry(config);
  Pose T_world_first;
  Pose error;
  for (std::uint64_t k = 0; k < 20; ++k) {
    const double start_s = 0.1 * static_cast<double>(k);
    Scan scan = test::scan_of(
        test::yard(), k16, 1800, [&](double s) { return pose_at(start_s + 0.1 * s); }, k);
    scan.motion_compensated = motion_compensated;
    const Estimate e = odometry.process(scan);
    const Pose truth = pose_at(start_s + 0.1);
    if (k == 0) T_world_first = truth;
    error = truth.inverse() * T_world_first * e.T_odom_sensor;
  }
  return error.translation_m.norm();
}

TEST(PaperOdometry, DeskewingAMovingSensorIsWorthIt) {
  const double two_stage = final_error_m(10.0, Deskew::two_stage);
  const double one_stage = final_error_m(10.0, Deskew::one_stage);
  const double none = final_error_m(10.0, Deskew::none);
  EXPECT_LT(two_stage, 0.5);  // 10 m driven, at 1 m a scan in the end
  EXPECT_LT(two_stage, 0.5 * none);
  EXPECT_LT(one_stage, none);
  EXPECT_NE(one_stage, two_stage);
  // What the authors of a data set deskewed is left alone.
  EXPECT_EQ(final_error_m(10.0, Deskew::two_stage, true), none);
}

/// Points in the map after ten scans on a way of 4.5 m without turning.
std::size_t map_size_after_a_drive(double keyframe_m) {
  OdometryConfig config = config_16();
  config.paper.keyframe_m = keyframe_m;
  Odometry odometry(config);
  for (std::uint64_t k = 0; k < 10; ++k) {
    const Eigen::Vector3d at_m(-6.0 + 0.5 * static_cast<double>(k), 0.0, 0.0);
    odometry.process(test::scan_of(
        test::yard(), k16, 1800,
        [&](double) {
          return Pose{Eigen::Quaterniond::Identity(), at_m};
        },
        k));
  }
  return odometry.map_points().size();
}

TEST(PaperOdometry, TheMapGrowsByKeyframes) {
  const std::size_t never_again = map_size_after_a_drive(9.0);
  const std::size_t each_metre = map_size_after_a_drive(1.0);
  const std::size_t each_scan = map_size_after_a_drive(0.0);
  EXPECT_LT(never_again, each_metre);
  EXPECT_LT(each_metre, each_scan);
}

TEST(PaperOdometry, KeepingMatchesForSmallMovesHardlyChangesTheAnswer) {
  const Pose step{so3_exp({0.01, -0.015, 0.05}), {0.4, -0.1, 0.05}};
  const auto found = [&](double search_again) {
    OdometryConfig config = config_16();
    config.paper.search_again = search_again;
    Odometry odometry(config);
    odometry.process(test::still_scan_of(test::yard(), k16, {}));
    return odometry.process(second_scan(test::yard(), step)).T_odom_sensor;
  };
  const Pose difference = found(0.0).inverse() * found(PaperConfig{}.search_again);
  EXPECT_LT(difference.translation_m.norm(), 0.01);
  EXPECT_GT(difference.translation_m.norm(), 0.0);
}

TEST(PaperOdometry, AnEmptyScanIsReportedAsLostAndDoesNotMoveThePose) {
  Odometry odometry(config_16());
  odometry.process(test::still_scan_of(test::yard(), k16, {}));
  Scan empty;
  empty.index = 1;
  empty.start_ns = 1'100'000'000;
  empty.end_ns = 1'200'000'000;
  empty.beams = k16;
  const Estimate e = odometry.process(empty);
  EXPECT_EQ(e.status, TrackingStatus::lost);
  EXPECT_NEAR(e.T_odom_sensor.translation_m.norm(), 0.0, 1e-9);
}

TEST(PaperOdometry, AScanWithoutBeamsIsNoReasonToThrow) {
  Odometry odometry(config_16());
  EXPECT_NO_THROW(odometry.process(Scan{}));
  EXPECT_NO_THROW(odometry.process(Scan{}));
}

}  // namespace
}  // namespace lilo::paper
