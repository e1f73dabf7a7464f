// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/reported_end.hpp"

#include "core/odometry.hpp"
#include "tests/core/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace lilo::core {
namespace {

const BeamTable kBeams = test::even_beams(16, -15.0, 15.0);

// Solver.Reports* have the cases in which a step is found.
TEST(ReportedEnd, IsThatOfTheTrajectoryWhereNoStepIsFound) {
  constexpr int kUnknowns = 2 * kKnotSize;
  Trajectory trajectory;
  trajectory.twist.linear_mps.x() = 3.0;
  trajectory.knots = Unknowns::Zero(kUnknowns);
  const KnotInformation information = 5.0 * KnotInformation::Identity();
  GaussNewtonStep last;
  last.data = {NormalMatrix::Identity(kUnknowns, kUnknowns), Unknowns::Zero(kUnknowns)};
  last.data.b[7] = std::numeric_limits<double>::quiet_NaN();
  last.from = last.step = Unknowns::Zero(kUnknowns);
  const MotionState reported = reported_end(last, Prior{}, trajectory, information);
  EXPECT_NEAR(reported.T_odom_sensor.translation_m.x(), 0.3, 1e-9);
  EXPECT_EQ(reported.twist.linear_mps.x(), 3.0);
  EXPECT_EQ(reported.information, information);
}

// The end of the trajectory is off by 0.44 mrad, the reported pose by 0.32.
TEST(ReportedEnd, OfAStillSensorHasLittleNoise) {
  constexpr int kFirst = 20, kScans = 80;
  std::mt19937 rng(1);
  Odometry odometry{OdometryConfig{}};
  double squares = 0.0;
  for (int k = 0; k < kScans; ++k) {
    Scan scan = test::scan_of(
        test::yard(), kBeams, 900, [](double) { return Pose{}; }, static_cast<std::uint64_t>(k));
    test::add_range_noise(scan, 0.03F, rng);
    const Estimate e = odometry.process(scan);
    if (k >= kFirst) squares += so3_log(e.T_odom_sensor.rotation).squaredNorm();
  }
  EXPECT_LT(std::sqrt(squares / (kScans - kFirst)), 0.38e-3);
}

}  // namespace
}  // namespace lilo::core
