// A sensor that stands is not dragged along by what sets off around it.
#include "core/motion/standing.hpp"

#include "core/odometry.hpp"
#include "tests/core/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace lilo {
namespace {

using core::Prior;
using core::Standing;

const BeamTable k16 = test::even_beams(16, -15.0, 15.0);

/// A road between two walls with posts along it, and a lane of vehicles on either side of the
/// sensor that set off at 0.5 m/s2 a second after the start.
test::Scene jam(double t_s) {
  constexpr double kSetOff_s = 1.0, kAcceleration_mps2 = 0.5;
  const double since_s = std::max(0.0, t_s - kSetOff_s);
  const double by_m = 0.5 * kAcceleration_mps2 * since_s * since_s;
  test::Scene scene;
  scene.planes = {{{0.0, 0.0, 1.0}, -1.5}, {{0.0, -1.0, 0.0}, -12.0}, {{0.0, 1.0, 0.0}, -12.0}};
  for (int k = -3; k <= 3; ++k) {
    for (const double side : {-1.0, 1.0}) {
      scene.poles.push_back({7.0 * k + 2.0 * side, 9.0 * side, 0.3, 4.0});
      scene.poles.push_back({6.0 * k + 1.0 * side + by_m, 3.4 * side, 0.9, 1.6});
    }
  }
  return scene;
}

TEST(Standing, WhatSetsOffAroundTheSensorDoesNotDragIt) {
  Odometry odometry{OdometryConfig{}};
  std::mt19937 rng(1);
  for (int k = 0; k < 40; ++k) {
    Scan scan = test::scan_of(
        jam(0.1 * k), k16, 900, [](double) { return Pose{}; }, static_cast<std::uint64_t>(k));
    test::add_range_noise(scan, 0.02F, rng);
    const Estimate e = odometry.process(scan);
    EXPECT_LT(e.T_odom_sensor.translation_m.norm(), 0.05) << "scan " << k;
  }
}

TEST(Standing, IsSupposedAfterFiveScansWithoutMotionAndUntilTheSensorIsAway) {
  Standing standing;
  const Twist slow{{0.05, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  for (int scan = 0; scan < 5; ++scan) {
    EXPECT_FALSE(standing.is_likely());
    standing.observe({}, slow);
  }
  EXPECT_TRUE(standing.is_likely());
  standing.observe({Eigen::Quaterniond::Identity(), {0.09, 0.0, 0.0}}, slow);
  EXPECT_TRUE(standing.is_likely());
  standing.observe({Eigen::Quaterniond::Identity(), {0.11, 0.0, 0.0}}, slow);
  EXPECT_FALSE(standing.is_likely());
}

TEST(Standing, AMotionInBetweenCountsAnew) {
  Standing standing;
  const Twist slow, fast{{0.2, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  for (int scan = 0; scan < 4; ++scan) standing.observe({}, slow);
  standing.observe({}, fast);
  for (int scan = 0; scan < 4; ++scan) standing.observe({}, slow);
  EXPECT_FALSE(standing.is_likely());
}

TEST(Standing, TheHypothesisIsThePlaceWithoutSpeedAndKeepsWhatIsKnownOfRotation) {
  Standing standing;
  const Eigen::Vector3d place_m(3.0, -2.0, 0.5);
  standing.begin({Eigen::Quaterniond::Identity(), place_m});
  Prior prior;
  prior.T_begin.translation_m = place_m + Eigen::Vector3d(0.04, 0.0, 0.0);
  prior.twist = {{0.4, 0.0, 0.0}, {0.0, 0.0, 0.2}};
  prior.begin_information *= 7.0;
  const Prior still = standing.hypothesis(prior);
  EXPECT_EQ(still.T_begin.translation_m, place_m);
  EXPECT_TRUE(still.twist.linear_mps.isZero());
  EXPECT_EQ(still.twist.angular_radps, prior.twist.angular_radps);
  EXPECT_EQ(still.begin_information(2, 2), 7.0);
  EXPECT_GT(still.begin_information(3, 3), 1.0 / (0.01 * 0.01));
}

}  // namespace
}  // namespace lilo
