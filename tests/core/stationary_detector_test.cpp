// SPDX-License-Identifier: BSD-3-Clause
// When a sensor is stationary, and when a scan may say so.
#include "core/motion/stationary_detector.hpp"

#include "core/odometry.hpp"
#include "core/registration/comparison.hpp"
#include "tests/core/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lilo::core {
namespace {

TEST(StationaryDetector, IsSupposedAfterFiveScansWithoutMotionAndUntilTheSensorIsAway) {
  StationaryDetector detector;
  const Twist slow{{0.05, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  for (int scan = 0; scan < 5; ++scan) {
    EXPECT_FALSE(detector.is_stationary());
    detector.observe({}, slow);
  }
  EXPECT_TRUE(detector.is_stationary());
  detector.observe({Eigen::Quaterniond::Identity(), {0.09, 0.0, 0.0}}, slow);
  EXPECT_TRUE(detector.is_stationary());
  detector.observe({Eigen::Quaterniond::Identity(), {0.11, 0.0, 0.0}}, slow);
  EXPECT_FALSE(detector.is_stationary());
}

TEST(StationaryDetector, AMotionInBetweenCountsAnew) {
  StationaryDetector detector;
  const Twist slow, fast{{0.2, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  for (int scan = 0; scan < 4; ++scan) detector.observe({}, slow);
  detector.observe({}, fast);
  for (int scan = 0; scan < 4; ++scan) detector.observe({}, slow);
  EXPECT_FALSE(detector.is_stationary());
}

TEST(StationaryDetector, TheHypothesisIsThePlaceWithoutSpeedAndKeepsWhatIsKnownOfRotation) {
  StationaryDetector detector;
  const Eigen::Vector3d place_m(3.0, -2.0, 0.5);
  detector.assume({Eigen::Quaterniond::Identity(), place_m});
  Prior prior;
  prior.T_begin.translation_m = place_m + Eigen::Vector3d(0.04, 0.0, 0.0);
  prior.twist = {{0.4, 0.0, 0.0}, {0.0, 0.0, 0.2}};
  prior.begin_information *= 7.0;
  const Prior still = detector.hypothesis(prior);
  EXPECT_EQ(still.T_begin.translation_m, place_m);
  EXPECT_TRUE(still.twist.linear_mps.isZero());
  EXPECT_EQ(still.twist.angular_radps, prior.twist.angular_radps);
  EXPECT_EQ(still.begin_information(2, 2), 7.0);
  EXPECT_GT(still.begin_information(3, 3), 1.0 / (0.01 * 0.01));
}

/// An alignment that ends `x_m` ahead, whose scan tells of x `times` as much as its duration does.
Solution alignment(double x_m, double structure_inliers, double times) {
  Solution solution;
  solution.trajectory.T_begin.translation_m.x() = x_m;
  solution.trajectory.knots = Unknowns::Zero(Eigen::Index{2} * kKnotSize);
  solution.structure_inliers = structure_inliers;
  solution.motion_information = Matrix6d::Identity();
  solution.data_information = 1e4 * Matrix6d::Identity();
  solution.data_information(3, 3) = times;
  return solution;
}

TEST(Comparison, AnAlignmentFitsAsWellThatLosesLessThanATwentieth) {
  EXPECT_TRUE(fits_as_well(alignment(0.0, 96.0, 100.0), alignment(0.1, 100.0, 100.0)));
  EXPECT_FALSE(fits_as_well(alignment(0.0, 94.0, 100.0), alignment(0.1, 100.0, 100.0)));
}

TEST(Comparison, ACorridorDoesNotTellAPlaceFromAnotherAlongIt) {
  EXPECT_TRUE(tells_apart(alignment(0.0, 100.0, 50.0), alignment(0.1, 100.0, 50.0)));
  EXPECT_FALSE(tells_apart(alignment(0.0, 100.0, 5.0), alignment(0.1, 100.0, 5.0)));
}

/// Two lanes of vehicles, which set off at 2 s, and tall posts behind them.
test::Scene jam(double t_s, double acceleration_mps2, double post_m) {
  test::Scene scene;
  scene.planes = {{{0.0, 0.0, 1.0}, -1.8}};
  const double moved_m = 0.5 * acceleration_mps2 * std::pow(std::max(0.0, t_s - 2.0), 2.0);
  for (int k = -6; k <= 6; ++k) {
    scene.poles.push_back({5.5 * k + moved_m, 3.0, 0.9, 0.0});
    scene.poles.push_back({5.5 * k + 2.0 + moved_m, -3.0, 0.9, 0.0});
  }
  for (int k = -4; k <= 4; ++k) {
    scene.poles.push_back({9.0 * k + 1.5 * std::sin(2.0 * k), 9.0, post_m, 6.0});
    scene.poles.push_back({8.0 * k + 2.0 + 1.5 * std::sin(3.0 * k), -9.0, post_m, 6.0});
  }
  return scene;
}

// Less of the structure stands than sets off, but only what stands is taller than a vehicle.
TEST(Jam, ASensorAtRestStaysWithWhatIsTallerThanVehicles) {
  for (const double acceleration_mps2 : {0.3, 1.0}) {
    for (const double post_m : {0.6, 0.3, 0.25}) {
      Odometry odometry{OdometryConfig{}};
      double farthest_m = 0.0;
      int tracked = 0;
      for (int k = 0; k < 70; ++k) {
        const Scan scan = test::scan_of(
            jam(0.1 * k, acceleration_mps2, post_m), test::even_beams(16, -15.0, 15.0), 900,
            [](double) { return Pose{}; }, static_cast<std::uint64_t>(k));
        const Estimate e = odometry.process(scan);
        farthest_m = std::max(farthest_m, e.T_odom_sensor.translation_m.norm());
        tracked += e.status == TrackingStatus::tracking ? 1 : 0;
      }
      EXPECT_LT(farthest_m, 0.1) << acceleration_mps2 << " m/s^2, posts of " << post_m << " m";
      EXPECT_GT(tracked, 60) << acceleration_mps2 << " m/s^2, posts of " << post_m << " m";
    }
  }
}

}  // namespace
}  // namespace lilo::core
