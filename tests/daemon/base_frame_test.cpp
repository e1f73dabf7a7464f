// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/base_frame.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace lilo {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;

TEST(BaseFrame, RollPitchYawAreAboutFixedAxes) {
  const Pose left = to_pose({.x_m = 1.0, .yaw_rad = kQuarter});
  EXPECT_NEAR((left * Eigen::Vector3d::UnitX() - Eigen::Vector3d(1, 1, 0)).norm(), 0.0, 1e-12)
      << "a sensor turned left sees forward what is at the robot's left";
  const Pose down = to_pose({.pitch_rad = kQuarter});
  EXPECT_NEAR((down * Eigen::Vector3d::UnitX() + Eigen::Vector3d::UnitZ()).norm(), 0.0, 1e-12)
      << "positive pitch looks down";
  const Pose both = to_pose({.roll_rad = kQuarter, .yaw_rad = kQuarter});
  EXPECT_NEAR((both * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitZ()).norm(), 0.0, 1e-12)
      << "roll first, then yaw";
}

// A robot that turns on the spot by 90 degrees with its sensor 1 m ahead: the sensor swings round,
// the base stays.
TEST(BaseFrame, TurningOnTheSpotLeavesTheBaseInPlace) {
  const Pose mount = to_pose({.x_m = 1.0});
  Estimate sensor;
  sensor.T_odom_sensor = {so3_exp({0, 0, kQuarter}), {-1.0, 1.0, 0.0}};
  sensor.twist = {.linear_mps = {0.0, 0.5, 0.0}, .angular_radps = {0.0, 0.0, 0.5}};
  const Estimate base = in_base_frame(sensor, mount);
  EXPECT_NEAR(base.T_odom_sensor.translation_m.norm(), 0.0, 1e-12);
  EXPECT_NEAR(so3_log(base.T_odom_sensor.rotation).z(), kQuarter, 1e-12);
  EXPECT_NEAR(base.twist.linear_mps.norm(), 0.0, 1e-12);
  EXPECT_NEAR(base.twist.angular_radps.z(), 0.5, 1e-12);
}

// The covariance against many small motions of the sensor, each carried over as a pose.
TEST(BaseFrame, CovarianceIsThatOfTheSamples) {
  const Pose mount = to_pose({.x_m = 0.5, .z_m = 1.2, .roll_rad = 0.3, .yaw_rad = -0.8});
  const Pose at{so3_exp({0.1, 0.2, 1.0}), {5.0, -3.0, 0.5}};
  Vector6d sigma;
  sigma << 1e-3, 2e-3, 3e-3, 1e-3, 5e-4, 2e-3;
  Estimate sensor;
  sensor.T_odom_sensor = at;
  sensor.covariance = sigma.cwiseAbs2().asDiagonal();
  const Estimate base = in_base_frame(sensor, mount);

  std::mt19937 rng(4);
  std::normal_distribution<double> normal;
  Matrix6d sampled = Matrix6d::Zero();
  constexpr int kSamples = 20000;
  for (int k = 0; k < kSamples; ++k) {
    Vector6d s;
    for (int i = 0; i < 6; ++i) s[i] = sigma[i] * normal(rng);
    Estimate moved;
    moved.T_odom_sensor = at * Pose{so3_exp(s.tail<3>()), s.head<3>()};
    const Pose d = base.T_odom_sensor.inverse() * in_base_frame(moved, mount).T_odom_sensor;
    Vector6d x;
    x << d.translation_m, so3_log(d.rotation);
    sampled += x * x.transpose() / kSamples;
  }
  EXPECT_LT((sampled - base.covariance).norm(), 0.03 * base.covariance.norm());
}

// A sensor that looks to the left, in a corridor along its y axis: the base drives along x. And a
// weak turn about the sensor's upright axis moves the base, which lies half a metre off.
TEST(BaseFrame, WeakDirectionsTurnWithIt) {
  const Pose mount = to_pose({.y_m = 0.5, .yaw_rad = -std::acos(0.0)});
  Estimate sensor;
  sensor.weak_count = 2;
  sensor.weak_directions[0] = {Vector6d::Unit(1), 0.25};
  sensor.weak_directions[1] = {Vector6d::Unit(5), 0.5};
  const Estimate base = in_base_frame(sensor, mount);
  EXPECT_EQ(base.weak_count, 2);
  EXPECT_TRUE(base.weak_directions[0].direction.isApprox(Vector6d::Unit(0), 1e-12));
  EXPECT_EQ(base.weak_directions[0].from_scan, 0.25);
  Vector6d turn = Vector6d::Unit(5);
  turn.x() = 0.5;  // (0, 0.5, 0) x z: the base's origin swings towards x
  EXPECT_TRUE(base.weak_directions[1].direction.isApprox(turn.normalized(), 1e-12));
}

}  // namespace
}  // namespace lilo
