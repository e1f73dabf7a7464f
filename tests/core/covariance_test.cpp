// SPDX-License-Identifier: BSD-3-Clause
#include "core/odometry.hpp"
#include "core/tracking/drift.hpp"
#include "tests/core/analytic_scene.hpp"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace lilo {
namespace {

/// 2 s of driving and turning, from another place and at another speed in every run.
Pose drive(double t_s, int run) {
  const double speed_mps = 1.0 + 0.3 * run;
  const double way_m = speed_mps * t_s * t_s / (1.0 + t_s);
  return {so3_exp({0.0, 0.0, 0.3 * run + 0.05 * way_m}),
          Eigen::Vector3d(-6.0 + 0.3 * run + way_m, -1.0 + 0.2 * run, 0.0)};
}

struct End {
  Vector6d error;  // x y z rx ry rz
  Matrix6d covariance;
};

End end_of(int run) {
  std::mt19937 rng(static_cast<unsigned>(run));
  Odometry odometry{OdometryConfig{}};
  Pose first, truth;
  Estimate last;
  for (int k = 0; k < 20; ++k) {
    Scan scan = test::scan_of(
        test::yard(), test::even_beams(16, -15.0, 15.0), 900,
        [&](double s) { return drive(0.1 * (k + s), run); }, static_cast<std::uint64_t>(k));
    test::add_range_noise(scan, 0.02F, rng);
    last = odometry.process(scan);
    truth = drive(0.1 * (k + 1), run);
    if (k == 0) first = truth;
  }
  const Pose error = (first.inverse() * truth).inverse() * last.T_odom_sensor;
  EXPECT_TRUE(last.has_covariance);
  End end{Vector6d::Zero(), last.covariance};
  end.error << error.translation_m, so3_log(error.rotation);
  return end;
}

// An exact covariance has 6 on average, in 95 % of such tests 4.2 to 8.1. Ours knows nothing of how
// the errors of a map hang together: it shall be of the right size, within a factor of two in
// sigma.
TEST(Covariance, IsOfTheRightSize) {
  constexpr int kRuns = 12;
  double sum = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const End end = end_of(run);
    const Eigen::LLT<Matrix6d> root(end.covariance);
    ASSERT_EQ(root.info(), Eigen::Success);
    sum += end.error.dot(root.solve(end.error));
  }
  EXPECT_LT(sum / kRuns, 6.0 * 4.0);
  EXPECT_GT(sum / kRuns, 6.0 / 4.0);
}

// A yard that is always in view holds the map fast; along a road it is built on and on.
TEST(Covariance, GrowsWithTheWay) {
  test::Scene road;
  road.planes = {{{0.0, 0.0, 1.0}, -1.8}};
  for (int k = 0; k < 55; ++k) {
    const double along_m = -50.0 + 8.0 * k + 2.0 * std::sin(2.0 * k);
    road.poles.push_back({along_m, k % 2 == 0 ? 9.0 : -7.0, 0.25, 3.0});
  }
  Odometry odometry{OdometryConfig{}};
  Matrix6d early = Matrix6d::Zero(), late = early;
  for (int k = 0; k < 200; ++k) {
    const Scan scan = test::scan_of(
        road, test::even_beams(16, -15.0, 15.0), 900,
        [&](double s) {
          return Pose{Eigen::Quaterniond::Identity(), {1.0 * (k + s), 0.0, 0.0}};
        },
        static_cast<std::uint64_t>(k));
    late = odometry.process(scan).covariance;
    if (k == 30) early = late;
  }
  for (int k = 0; k < 6; ++k) EXPECT_GT(late(k, k), early(k, k)) << k;
  // Errors of heading move aside what lies ahead: by the way squared, and more as they add up.
  EXPECT_GT(late(1, 1), 20.0 * early(1, 1));
}

TEST(Drift, AnErrorOfHeadingMovesAsideWhatLiesAhead) {
  core::Drift drift;
  Matrix6d heading = Matrix6d::Zero();
  heading(2, 2) = 1e-4;  // 0.01 rad about z
  drift.begin(heading);
  drift.move({100.0, 0.0, 0.0});
  EXPECT_NEAR(drift.covariance()(4, 4), 1.0, 1e-9);          // 1 m to the left or right
  EXPECT_NEAR(drift.covariance()(3, 3), 0.03 * 0.03, 1e-9);  // the scale: 3e-4 of the way
  EXPECT_NEAR(drift.covariance()(2, 4), 0.01, 1e-9);         // to the left where it turns left
}

// The beams' part is no sum over keyframes: each call has all of it. A new map begins with it.
TEST(Drift, TheBeamsPartIsReplacedAndMovesOn) {
  core::Drift drift;
  drift.begin(Matrix6d::Zero());
  Matrix6d pitch = Matrix6d::Zero();
  pitch(1, 1) = 1e-4;  // 0.01 rad about y
  drift.set_beam_covariance(pitch);
  drift.set_beam_covariance(pitch);
  drift.move({100.0, 0.0, 0.0});
  EXPECT_NEAR(drift.covariance()(1, 1), 1e-4, 1e-12);
  EXPECT_NEAR(drift.covariance()(5, 5), 1.0, 1e-9);  // 1 m up or down
  drift.begin(drift.covariance());
  drift.set_beam_covariance(Matrix6d::Zero());
  EXPECT_NEAR(drift.covariance()(5, 5), 1.0, 1e-9);
}

// An error of the first scan's attitude turns the whole way, and is not counted twice.
TEST(Drift, TheFirstScansPartTurnsTheWay) {
  core::Drift drift;
  drift.begin(Matrix6d::Zero());
  Matrix6d heading = Matrix6d::Zero();
  heading(2, 2) = 1e-4;  // 0.01 rad about z
  drift.move({60.0, 0.0, 0.0});
  drift.set_first_scan(heading);
  drift.set_first_scan(heading);
  drift.move({40.0, 0.0, 0.0});
  EXPECT_NEAR(drift.covariance()(2, 2), 1e-4, 1e-12);
  EXPECT_NEAR(drift.covariance()(4, 4), 1.0, 1e-9);  // 1 m to the left or right
  drift.begin(Matrix6d::Zero());
  EXPECT_EQ(drift.covariance(), Matrix6d::Zero());
}

// Of what the scale is wrong by, nothing is left where the way ends at its beginning.
TEST(Drift, AnErrorOfScaleGrowsWithTheDistanceFromTheStartAndComesBack) {
  core::Drift drift;
  drift.begin(Matrix6d::Zero());
  drift.move({300.0, 0.0, 0.0});
  drift.move({0.0, 400.0, 0.0});
  EXPECT_NEAR(std::sqrt(drift.covariance().block<3, 3>(3, 3).trace()), 3e-4 * 500.0, 1e-9);
  drift.move({-300.0, -400.0, 0.0});
  EXPECT_NEAR(drift.covariance().norm(), 0.0, 1e-12);
}

/// Of a keyframe's standard error a thirteenth is handed on, and half as much again is correlated
/// over thirteen keyframes.
constexpr double kPart = 1.0 / 13.0, kCorrelated = 0.5, kCorrelationKeyframes = 13.0;

/// Variance of the sum of s[k] (e[k] + kCorrelated c[k]) kPart, in parts of that of one e[k], which
/// are independent; c[k] is exponentially correlated.
double variance_of_sum(const std::vector<double>& s) {
  double sum = 0.0;
  for (std::size_t j = 0; j < s.size(); ++j) {
    sum += s[j] * s[j];
    for (std::size_t k = 0; k < s.size(); ++k) {
      const double apart = std::abs(static_cast<double>(j) - static_cast<double>(k));
      sum += kCorrelated * kCorrelated * s[j] * s[k] * std::exp(-apart / kCorrelationKeyframes);
    }
  }
  return kPart * kPart * sum;
}

/// Of x, after keyframes that look ahead (1) or back (-1).
double variance_after(const std::vector<double>& looks) {
  constexpr double kVariance_m2 = 1e-4;
  constexpr int kOldMap = 100;
  const Eigen::Quaterniond ahead = Eigen::Quaterniond::Identity();
  const Eigen::Quaterniond back(0.0, 0.0, 0.0, 1.0);  // about the upright
  Matrix6d alignment = Matrix6d::Zero();
  alignment(3, 3) = alignment(4, 4) = kVariance_m2;
  core::Drift drift;
  for (const double look : looks) drift.inherit(alignment, look > 0.0 ? ahead : back, kOldMap);
  return drift.covariance()(3, 3) / kVariance_m2;
}

TEST(Drift, ACorrelatedErrorAddsUpAlongTheWay) {
  const std::vector<double> away(1000, 1.0);
  EXPECT_NEAR(variance_after(away) / variance_of_sum(away), 1.0, 1e-9);
  // Over a long way, the variance of a correlated error counts twice for each of the keyframes over
  // which it is correlated.
  EXPECT_NEAR(
      variance_after(away) / (kPart * kPart * 1000.0 *
                              (1.0 + kCorrelated * kCorrelated * 2.0 * kCorrelationKeyframes)),
      1.0, 0.06);
}

TEST(Drift, ACorrelatedErrorCancelsWhereTheSensorTurnsBack) {
  std::vector<double> loop(20, 1.0);
  loop.resize(40, -1.0);
  EXPECT_NEAR(variance_after(loop) / variance_of_sum(loop), 1.0, 1e-9);
  const std::vector<double> away(40, 1.0);
  const double independent = 40.0 * kPart * kPart;
  EXPECT_LT(variance_after(loop) - independent, 0.5 * (variance_after(away) - independent));
}

// A position under white noise q on acceleration is uncertain by q t^3 / 3.
TEST(Drift, WhatNoScanTellsIsDeadReckoned) {
  constexpr double kDensity = 3.0, kScan_s = 0.01;
  core::Drift drift;
  core::Drift::Motions motions = core::Drift::Motions::Zero();
  motions.col(0).tail<3>() = std::sqrt(kDensity) * Eigen::Vector3d(0.6, 0.8, 0.0);
  for (int scan = 0; scan < 1000; ++scan) drift.coast(motions, kScan_s, true);
  const Matrix6d covariance = drift.covariance();
  EXPECT_NEAR(covariance(3, 3) / (0.36 * kDensity * 1000.0 / 3.0), 1.0, 0.01);
  EXPECT_NEAR(covariance(4, 4) / (0.64 * kDensity * 1000.0 / 3.0), 1.0, 0.01);
  EXPECT_EQ(covariance(5, 5), 0.0);
  EXPECT_EQ(drift.recent(), covariance);
  drift.coast(motions, kScan_s, false);
  EXPECT_EQ(drift.recent(), covariance);
  EXPECT_GT(drift.covariance()(3, 3), covariance(3, 3));
  drift.rewind();
  EXPECT_EQ(drift.recent(), Matrix6d::Zero());
}

// In a bend of 0.1 rad/m an error of a metre along is an error of 0.1 rad.
TEST(Drift, DeadReckoningInABendTurnsToo) {
  core::Drift drift;
  core::Drift::Motions motions = core::Drift::Motions::Zero();
  motions.col(0) << 0.0, 0.0, 0.1, 1.0, 0.0, 0.0;
  for (int scan = 0; scan < 100; ++scan) drift.coast(motions, 0.1, true);
  const Matrix6d covariance = drift.covariance();
  EXPECT_NEAR(covariance(2, 2) / covariance(3, 3), 0.01, 1e-9);
  EXPECT_NEAR(covariance(2, 3) / covariance(3, 3), 0.1, 1e-9);
  EXPECT_GT(covariance(3, 3), 100.0);
}

TEST(Drift, SensorAxesTurnWithTheSensor) {
  Matrix6d along_x = Matrix6d::Zero();
  along_x(3, 3) = 4.0;
  const Eigen::Quaterniond left(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()));
  const Matrix6d seen = core::translation_first(core::in_sensor_axes(along_x, left));
  EXPECT_NEAR(seen(1, 1), 4.0, 1e-12);  // odometry's x is on the sensor's right
  EXPECT_NEAR(seen(0, 0), 0.0, 1e-12);
}

}  // namespace
}  // namespace lilo
