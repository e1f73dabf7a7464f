// SPDX-License-Identifier: BSD-3-Clause
// The first scans after the start are compared with the last one of it.
#include "core/odometry.hpp"
#include "tests/core/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

namespace lilo {
namespace {

constexpr double kTurn_rad = 0.7;

/// The yaw that is found at last by a sensor that turns abruptly within scan `turning`.
double yaw_after_turn(double speed_mps, int turning) {
  const auto at = [&](double t_s) {
    const double since_s = std::clamp(t_s - 0.1 * turning, 0.0, 0.1);
    return Pose{so3_exp({0.0, 0.0, 10.0 * since_s * kTurn_rad}), {speed_mps * t_s, 0.0, 0.0}};
  };
  Odometry odometry{OdometryConfig{}};
  Estimate last;
  for (int k = 0; k < turning + 4; ++k) {
    last = odometry.process(test::scan_of(
        test::yard(), test::even_beams(16, -15.0, 15.0), 900,
        [&](double s) { return at(0.1 * (k + s)); }, static_cast<std::uint64_t>(k)));
  }
  return so3_log(last.T_odom_sensor.rotation).z();
}

// At rest the fourth scan is the first one after the start, in motion the sixth.
TEST(AfterStart, AnAbruptTurnIsFollowed) {
  for (const int turning : {3, 4, 5}) {
    EXPECT_NEAR(yaw_after_turn(0.0, turning), kTurn_rad, 0.02) << turning;
  }
  for (const int turning : {5, 6, 7}) {
    EXPECT_NEAR(yaw_after_turn(4.0, turning), kTurn_rad, 0.02) << turning;
  }
}

}  // namespace
}  // namespace lilo
