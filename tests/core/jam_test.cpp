// SPDX-License-Identifier: BSD-3-Clause
// Vehicles around a sensor at rest set off together.
#include "core/odometry.hpp"
#include "tests/core/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lilo::core {
namespace {

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

// Thin posts do not hold the sensor at rest, and it follows the vehicles, faster than 5 m/s at
// last. The posts tell that it does, and the covariance counts it.
TEST(Jam, IsNotTrackingWhileItFollowsVehicles) {
  constexpr double kThin_m = 0.05;
  Odometry odometry{OdometryConfig{}};
  double off_m = 0.0;
  for (int k = 0; k < 70; ++k) {
    const Scan scan = test::scan_of(
        jam(0.1 * k, 1.0, kThin_m), test::even_beams(16, -15.0, 15.0), 900,
        [](double) { return Pose{}; }, static_cast<std::uint64_t>(k));
    const Estimate e = odometry.process(scan);
    off_m = e.T_odom_sensor.translation_m.norm();
    EXPECT_TRUE(off_m < 1.0 || e.status != TrackingStatus::tracking) << off_m << " m, scan " << k;
    if (off_m < 2.0) continue;  // it takes some scans to be seen
    EXPECT_TRUE(e.is_uncertain || e.status == TrackingStatus::lost) << off_m << " m, scan " << k;
    const double sigma_m = std::sqrt(e.covariance.topLeftCorner<2, 2>().trace());
    EXPECT_LT(off_m, 4.0 * sigma_m) << "scan " << k;
  }
  EXPECT_GT(off_m, 10.0) << "it did not follow them";
}

}  // namespace
}  // namespace lilo::core
