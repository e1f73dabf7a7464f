// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/weak_directions.hpp"

#include "core/odometry.hpp"
#include "core/pose.hpp"
#include "tests/core/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace lilo {
namespace {

const BeamTable k16 = test::even_beams(16, -15.0, 15.0);

/// A VLP-16's. Without any, and with the very same firings every turn, a wall is sampled at the
/// same places again and again: 60 m ahead, where rings are metres apart, they look like posts.
constexpr float kRangeNoise_m = 0.012F;

/// Drives straight along x and returns the last estimate.
Estimate drive_through(const test::Scene& scene) {
  Odometry odometry{OdometryConfig{}};
  std::mt19937 rng(1);
  Estimate last;
  for (int k = 0; k < 20; ++k) {
    Scan scan = test::scan_of(
        scene, k16, 900,
        [&](double s) {
          return Pose{Eigen::Quaterniond::Identity(), {0.05 * (k + s), 0.0, 0.0}};
        },
        static_cast<std::uint64_t>(k));
    test::add_range_noise(scan, kRangeNoise_m, rng);
    last = odometry.process(scan);
  }
  return last;
}

TEST(WeakDirections, IsTheOneThatTheScanLeavesToThePrediction) {
  Vector6d scan, prediction;
  scan << 900, 900, 900, 300, 25, 900;  // rx ry rz x y z
  prediction << 100, 100, 100, 100, 100, 100;
  const Eigen::Quaterniond quarter_turn(
      Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()));
  const auto weak = core::weak_directions(scan.asDiagonal(), prediction.asDiagonal(), quarter_turn);
  ASSERT_EQ(weak.count, 1);
  EXPECT_NEAR(weak.all[0].from_scan, 0.2, 1e-9);  // 25 of 125
  // y of the odometry's frame is x of a sensor that is turned left by a quarter.
  EXPECT_NEAR(std::abs(weak.all[0].direction[0]), 1.0, 1e-9);
}

TEST(WeakDirections, NoneWhereTheScanKnowsMore) {
  const Matrix6d one = Matrix6d::Identity();
  EXPECT_EQ(core::weak_directions(1.1 * one, one, Eigen::Quaterniond::Identity()).count, 0);
}

TEST(WeakDirections, AScanThatSaysNothingIsWeakEverywhere) {
  const auto weak =
      core::weak_directions(Matrix6d::Zero(), Matrix6d::Identity(), Eigen::Quaterniond::Identity());
  ASSERT_EQ(weak.count, 6);
  for (const WeakDirection& one : weak.all) EXPECT_EQ(one.from_scan, 0.0);
}

/// A scan that knows all but the way along a bend of `turn_radpm`, of which it seems to know a
/// tenth of what the motion tells.
struct Bend {
  explicit Bend(double turn_radpm) {
    along << 0.0, 0.0, turn_radpm, 1.0, 0.0, 0.0;  // rx ry rz x y z
    along.normalize();
    const Matrix6d across = Matrix6d::Identity() - along * along.transpose();
    scan = 1e4 * across + 0.1 * along * along.transpose();
  }
  Vector6d along;
  Matrix6d scan, motion = Matrix6d::Identity();
};

TEST(DeadReckoning, OnlyThePredictionMovesThePoseAlong) {
  const Bend bend(0.2);
  Vector6d deviation, gradient;
  deviation << 0.01, 0.02, 0.03, 0.4, -0.05, 0.06;
  gradient << 5.0, -4.0, 3.0, -200.0, 7.0, 8.0;
  const Vector6d before = gradient;
  core::DeadReckoning(bend.scan, bend.motion).hold(deviation, bend.scan, gradient);
  // The same information, but as though the scan had been measured where it was predicted.
  EXPECT_NEAR(bend.along.dot(gradient), -0.1 * bend.along.dot(deviation), 1e-9);
  const Matrix6d across = Matrix6d::Identity() - bend.along * bend.along.transpose();
  EXPECT_NEAR((across * (gradient - before)).norm(), 0.0, 1e-9);
  EXPECT_GT((gradient - before).norm(), 100.0);
}

TEST(DeadReckoning, NoneWhereTheScanTellsMore) {
  Bend bend(0.2);
  bend.scan += 0.2 * bend.along * bend.along.transpose();
  Vector6d gradient = Vector6d::Constant(3.0);
  core::DeadReckoning(bend.scan, bend.motion).hold(gradient, bend.scan, gradient);
  EXPECT_EQ(gradient, Vector6d::Constant(3.0));
}

// What mostly turns the sensor, the scan is asked all the same.
TEST(DeadReckoning, NoneThatMostlyTurns) {
  const Bend bend(5.0);
  Vector6d gradient = Vector6d::Constant(3.0);
  core::DeadReckoning(bend.scan, bend.motion).hold(gradient, bend.scan, gradient);
  EXPECT_EQ(gradient, Vector6d::Constant(3.0));
}

TEST(WeakDirections, AlongATunnel) {
  test::Scene tunnel;
  tunnel.planes = {{{0.0, 0.0, 1.0}, -1.5}, {{0.0, -1.0, 0.0}, -3.0}, {{0.0, 1.0, 0.0}, -3.0}};
  const Estimate e = drive_through(tunnel);
  ASSERT_EQ(e.weak_count, 1);
  EXPECT_GT(std::abs(e.weak_directions[0].direction[0]), 0.99);
  EXPECT_EQ(e.status, TrackingStatus::degraded);
}

TEST(WeakDirections, NoneInAYard) {
  const Estimate e = drive_through(test::yard());
  EXPECT_EQ(e.weak_count, 0);
  EXPECT_EQ(e.status, TrackingStatus::tracking);
}

}  // namespace
}  // namespace lilo
