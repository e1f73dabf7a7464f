// SPDX-License-Identifier: BSD-3-Clause
#include "core/tracking/local_odometry.hpp"

#include "tests/core/observed_scan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace lilo::core {
namespace {

constexpr std::size_t kMostFeatures = 20000;
constexpr double kSpan_s = 0.1;
constexpr std::int64_t kSpan_ns = 100'000'000;

const Eigen::Quaterniond kAhead = Eigen::Quaterniond::Identity();

/// Of the scan that begins `index` spans after the first.
ScanTiming timing_of(std::int64_t index) { return {index * kSpan_ns, (index + 1) * kSpan_ns}; }

Twist ahead(double speed_mps) { return {{speed_mps, 0.0, 0.0}, Eigen::Vector3d::Zero()}; }

/// Motion at constant twist from `T_begin`.
Trajectory steady(const Pose& T_begin, const Twist& twist) {
  Trajectory trajectory;
  trajectory.T_begin = T_begin;
  trajectory.twist = twist;
  trajectory.span_s = kSpan_s;
  trajectory.knots = Unknowns::Zero(Eigen::Index{kKnotSize} * 2);
  return trajectory;
}

Solution aligned(const Pose& T_begin, const Twist& twist, double information = 1e6) {
  Solution solution;
  solution.trajectory = steady(T_begin, twist);
  solution.end_information = information * KnotInformation::Identity();
  solution.reported = {solution.trajectory.end(), twist, solution.end_information, std::nullopt};
  solution.data_information = information * Matrix6d::Identity();
  solution.motion_information = Matrix6d::Identity();
  solution.looked_up = solution.matched = 1000;
  return solution;
}

class LocalOdometryTest : public testing::Test {
 protected:
  LocalOdometry local_{DefaultConfig{}, kMostFeatures};

  /// Driving along x from the origin at the end of the first scan, on a map of the yard.
  void begin_in_yard(double speed_mps) {
    const test::ObservedScan scan = in_yard(speed_mps, 0);
    local_.rewind(scan.timing());
    local_.begin_map_of(scan.features(),
                        steady({kAhead, {-speed_mps * kSpan_s, 0.0, 0.0}}, ahead(speed_mps)),
                        LocalMaps::kWhole);
  }
  static test::ObservedScan in_yard(double speed_mps, std::uint64_t index) {
    return {test::yard(), test::along_x(speed_mps, index), index};
  }
};

TEST_F(LocalOdometryTest, APredictionGoesOnAtConstantTwist) {
  const Twist twist{{10.0, 0.0, 0.0}, {0.0, 0.0, std::numbers::pi / 2}};
  local_.accept(timing_of(0), aligned({kAhead, {5.0, 0.0, 0.0}}, ahead(10.0)));
  EXPECT_NEAR(local_.state().T_odom_sensor.translation_m.x(), 6.0, 1e-9);
  EXPECT_EQ(local_.state().end_ns, kSpan_ns);
  local_.accept_prediction(timing_of(1), local_.predict(timing_of(1)));
  EXPECT_NEAR(local_.state().T_odom_sensor.translation_m.x(), 7.0, 1e-9);
  EXPECT_NEAR(local_.state().twist.linear_mps.x(), 10.0, 1e-9);
  EXPECT_EQ(local_.state().end_ns, 2 * kSpan_ns);
  // A quarter turn to the left in a second.
  local_.accept(timing_of(2), aligned({}, twist));
  for (int scan = 3; scan < 12; ++scan)
    local_.accept_prediction(timing_of(scan), local_.predict(timing_of(scan)));
  const Eigen::Vector3d looks = local_.state().T_odom_sensor.rotation * Eigen::Vector3d::UnitX();
  EXPECT_NEAR((looks - Eigen::Vector3d::UnitY()).norm(), 0.0, 1e-6);
}

TEST_F(LocalOdometryTest, APredictionIsLessCertainThanTheAlignmentBeforeIt) {
  local_.accept(timing_of(0), aligned({}, {}));
  const Matrix6d before = local_.covariance();
  local_.accept_prediction(timing_of(1), local_.predict(timing_of(1)));
  const Matrix6d after = local_.covariance();
  for (int k = 0; k < 6; ++k) EXPECT_GT(after(k, k), before(k, k)) << k;
}

// The next scan is predicted from the state, and the reported pose goes out.
TEST_F(LocalOdometryTest, TheReportedPoseIsNotWhereTheNextScanBegins) {
  Solution solution = aligned({}, ahead(10.0));
  solution.reported.T_odom_sensor.translation_m.x() = 1.02;
  solution.reported.twist = ahead(9.0);
  solution.reported.information *= 4.0;
  local_.accept(timing_of(0), aligned({}, ahead(10.0)));
  const Matrix6d of_state = local_.covariance();
  local_.accept(timing_of(0), solution);
  EXPECT_EQ(local_.reported().T_odom_sensor.translation_m.x(), 1.02);
  EXPECT_EQ(local_.reported().twist.linear_mps.x(), 9.0);
  EXPECT_LT(local_.covariance()(0, 0), of_state(0, 0));
  EXPECT_NEAR(local_.state().T_odom_sensor.translation_m.x(), 1.0, 1e-9);
  EXPECT_NEAR(local_.predict(timing_of(1)).T_begin.translation_m.x(), 1.0, 1e-9);
  local_.accept_prediction(timing_of(1), local_.predict(timing_of(1)));
  EXPECT_NEAR(local_.reported().T_odom_sensor.translation_m.x(), 2.0, 1e-9);
  local_.begin_map(timing_of(2));
  EXPECT_EQ(local_.reported().T_odom_sensor.translation_m, Eigen::Vector3d::Zero());
}

TEST_F(LocalOdometryTest, AnUnalignedSolutionIsThePrediction) {
  local_.accept(timing_of(0), aligned({}, ahead(3.0)));
  const Prior prior = local_.predict(timing_of(1));
  const Solution none = local_.unaligned(prior);
  EXPECT_EQ(none.matched, 0);
  EXPECT_NEAR(none.trajectory.end().translation_m.x(), 0.6, 1e-9);
  EXPECT_NEAR(none.reported.T_odom_sensor.translation_m.x(), 0.6, 1e-9);
}

TEST_F(LocalOdometryTest, FollowsADriveThroughAYard) {
  constexpr double kSpeed_mps = 4.0;
  begin_in_yard(kSpeed_mps);
  // What a motion search would have found.
  local_.accept(in_yard(kSpeed_mps, 0).timing(),
                aligned({kAhead, {-0.4, 0.0, 0.0}}, ahead(kSpeed_mps), 100.0));
  for (std::uint64_t k = 1; k <= 10; ++k) {
    const test::ObservedScan scan = in_yard(kSpeed_mps, k);
    const Solution solution = local_.align(scan.features(), local_.predict(scan.timing()));
    local_.accept(scan.timing(), solution);
    local_.grow_map({.timing = scan.timing(), .levels = Levels::from_whole}, scan.features(),
                    solution, MapUse::keyframe);
    const Eigen::Vector3d truth_m(kSpeed_mps * kSpan_s * static_cast<double>(k), 0.0, 0.0);
    EXPECT_NEAR((local_.state().T_odom_sensor.translation_m - truth_m).norm(), 0.0, 0.02) << k;
  }
  EXPECT_NEAR(local_.state().twist.linear_mps.x(), kSpeed_mps, 0.1);
  EXPECT_GT(local_.map().keyframes(), 5);
}

TEST_F(LocalOdometryTest, AnotherMapBeginsWhereItsFirstScanIsPredictedToEnd) {
  begin_in_yard(0.0);
  local_.accept(timing_of(1), aligned({kAhead, {5.0, 0.0, 0.0}}, ahead(10.0)));
  // The scan that is missing may have held any motion that the process noise allows.
  LocalOdometry predicted = local_;
  predicted.accept_prediction(timing_of(2), predicted.predict(timing_of(2)));
  const Matrix6d there = predicted.covariance();
  const Pose at = local_.begin_map(timing_of(2));
  EXPECT_NEAR(at.translation_m.x(), 7.0, 1e-9) << "10 m/s for a scan more";
  EXPECT_EQ(local_.state().T_odom_sensor.translation_m, Eigen::Vector3d::Zero());
  EXPECT_FALSE(local_.state().end_ns);
  EXPECT_EQ(local_.map().cells().size(), 0);
  for (int k = 0; k < 6; ++k) EXPECT_GE(local_.covariance()(k, k), there(k, k)) << k;
}

// At 10 m/s, looking half left. After 15 s without a scan the sensor is where it was, or 150 m on,
// or near.
TEST_F(LocalOdometryTest, AfterALongGapTheSensorMayBeAnywhere) {
  const Pose half_left{so3_exp({0.0, 0.0, std::numbers::pi / 4}), {}};
  const auto covariance_after = [&](std::int64_t first_scan) {
    LocalOdometry local = local_;
    local.accept(timing_of(200), aligned(half_left, ahead(10.0)));
    local.accept_prediction(timing_of(first_scan), local.predict(timing_of(first_scan)));
    // The next scan is a fragment, which cannot begin a map.
    local.accept_prediction(timing_of(first_scan + 1), local.predict(timing_of(first_scan + 1)));
    local.begin_map(timing_of(first_scan + 2));
    return local.covariance();  // in the sensor's axes
  };
  const double q_m2 = DefaultConfig{}.translation_density * 15.0 * 15.0 * 15.0 / 3.0;
  for (const std::int64_t first_scan : {351, 50}) {  // the clock may also have been set back
    const Matrix6d after = covariance_after(first_scan);
    EXPECT_NEAR(after(3, 3), 150.0 * 150.0 + q_m2, 0.02 * 150.0 * 150.0) << first_scan;
    EXPECT_NEAR(after(4, 4), q_m2, 0.05 * q_m2) << first_scan;
    EXPECT_NEAR(after(1, 1), std::numbers::pi * std::numbers::pi / 3.0, 1e-3) << first_scan;
  }
  EXPECT_LT(covariance_after(225)(3, 3), 30.0) << "2.4 s are predicted";
  EXPECT_LT(covariance_after(10'000'000'000)(3, 3), 1e6) << "the clock was set by 30 years";
}

// The velocity is unknown after the first scan, whether the gap is predicted or not.
TEST_F(LocalOdometryTest, ALongerGapAfterTheFirstScanIsNoMoreCertain) {
  const auto sigma_after = [&](std::int64_t scan) {
    LocalOdometry local = local_;
    local.accept_first(timing_of(0));
    local.begin_map(timing_of(scan));
    return std::sqrt(local.covariance()(3, 3));
  };
  EXPECT_GT(sigma_after(25), 10.0);
  EXPECT_GT(sigma_after(27), sigma_after(25));
  EXPECT_GT(sigma_after(150), 2.0 * sigma_after(27));
}

TEST_F(LocalOdometryTest, AGapIsForgottenOnceTheSensorIsFound) {
  local_.accept(timing_of(1), aligned({}, {}));
  const double before = local_.covariance()(3, 3);
  local_.accept_prediction(timing_of(152), local_.predict(timing_of(152)));
  EXPECT_GT(local_.covariance()(3, 3), 1000.0);
  local_.accept(timing_of(153), aligned({}, {}));
  EXPECT_NEAR(local_.covariance()(3, 3), before, 0.5 * before);
}

TEST_F(LocalOdometryTest, RewindingGoesBackToTheEndOfTheFirstScan) {
  local_.accept(timing_of(3), aligned({kAhead, {5.0, 0.0, 0.0}}, ahead(10.0)));
  local_.rewind(timing_of(0));
  EXPECT_EQ(local_.state().T_odom_sensor.translation_m, Eigen::Vector3d::Zero());
  EXPECT_EQ(local_.state().twist.linear_mps, Eigen::Vector3d::Zero());
  EXPECT_EQ(local_.state().end_ns, kSpan_ns);
}

// Mean velocities that change by 1 m/s from scan to scan: far more than the nominal noise.
TEST_F(LocalOdometryTest, AShakingMotionLoosensThePredictionUnlessItIsInterrupted) {
  const auto density_after = [](bool interrupted) {
    LocalOdometry local{DefaultConfig{}, kMostFeatures};
    double x_m = 0.0;
    for (int k = 0; k < 100; ++k) {
      x_m += (k % 2 == 0 ? 1.0 : 0.0) * kSpan_s;
      if (interrupted) local.interrupt_noise();
      local.observe_noise(timing_of(k), aligned({kAhead, {x_m, 0.0, 0.0}}, {}));
    }
    return local.predict(timing_of(100)).acceleration_density[3];
  };
  const double nominal = DefaultConfig{}.translation_density;
  EXPECT_EQ(density_after(true), nominal);
  // 1 m/s along x, none along y, which shares its density: 2/3 q T is 0.5 m^2/s^2. That counts
  // eight times, since what shakes faster cancels in part from scan to scan.
  EXPECT_NEAR(density_after(false), 8.0 * 0.5 * 3.0 / (2.0 * kSpan_s), 0.1);
}

TEST_F(LocalOdometryTest, AWeakDirectionMakesThePoseUncertainAlongIt) {
  local_.accept(timing_of(0), aligned({}, {}));
  const Matrix6d before = local_.covariance();
  Solution solution = aligned({}, {});
  solution.data_information(4, 4) = 0.1;  // y: a tenth of what the duration alone says
  const WeakDirections weak = local_.find_weak_directions(timing_of(1), solution);
  ASSERT_EQ(weak.count, 1);
  EXPECT_NEAR(std::abs(weak.all[0].direction[1]), 1.0, 1e-9);
  EXPECT_NEAR(weak.all[0].from_scan, 1.0 / 11.0, 1e-9);
  const Matrix6d after = local_.covariance();
  // By q t^3 of one scan.
  EXPECT_NEAR(after(4, 4) - before(4, 4), DefaultConfig{}.translation_density * 1e-3, 1e-9);
  EXPECT_NEAR(after(3, 3), before(3, 3), 1e-12);
}

/// At rest in the yard, and then off along x at 2 m/s^2.
TEST_F(LocalOdometryTest, ASensorIsFollowedWhenItSetsOff) {
  const auto x_m = [](double t_s) { return std::pow(std::max(0.0, t_s - 1.0), 2.0); };
  begin_in_yard(0.0);
  for (std::uint64_t k = 1; k <= 20; ++k) {
    const double begin_s = kSpan_s * static_cast<double>(k);
    const auto path = [&](double s) {
      return Pose{kAhead, {x_m(begin_s + s * kSpan_s), 0.0, 0.0}};
    };
    const test::ObservedScan scan(test::yard(), path, k);
    const Solution solution = local_.align(scan.features(), local_.predict(scan.timing()));
    local_.accept(scan.timing(), solution);
    local_.grow_map({.timing = scan.timing(), .levels = Levels::from_whole}, scan.features(),
                    solution, MapUse::keyframe);
    const Eigen::Vector3d error_m =
        local_.state().T_odom_sensor.translation_m - path(1.0).translation_m;
    EXPECT_LT(error_m.norm(), 0.02) << k;
  }
}

/// Middles of scans 2 cm apart by turns: the velocity changes by 0.4 m/s every time.
void shake(LocalOdometry& local, std::int64_t first, std::int64_t scans) {
  for (std::int64_t k = first; k < first + scans; ++k) {
    const Pose T{kAhead, {k % 2 == 0 ? 0.0 : 0.02, 0.0, 0.0}};
    local.observe_noise(timing_of(k), aligned(T, {}, 1e12));
  }
}

// q is 3/2 of the square over T, half of that for each of x and y; the first scan has 8/135 q T^3.
TEST_F(LocalOdometryTest, TheFirstScanIsAsUncertainAsTheMotionAfterIt) {
  constexpr double kDensity = 0.5 * 1.5 * 0.4 * 0.4 / kSpan_s;
  constexpr double kVariance_m2 = 8.0 / 135.0 * kDensity * kSpan_s * kSpan_s * kSpan_s;
  begin_in_yard(0.0);
  const Matrix6d before = local_.covariance();
  shake(local_, 1, 10);
  const Matrix6d more = local_.covariance() - before;
  EXPECT_NEAR(more(3, 3) / kVariance_m2, 1.0, 1e-3);
  EXPECT_NEAR(more(4, 4) / kVariance_m2, 1.0, 1e-3);
  EXPECT_NEAR(more(5, 5) / kVariance_m2, 0.0, 1e-3);
  local_.rewind(timing_of(0));
  shake(local_, 12, 2);
  EXPECT_TRUE(local_.covariance().isApprox(before));
  shake(local_, 14, 1);  // the third pose in a row tells a change
  EXPECT_GT(local_.covariance()(3, 3), before(3, 3) + 0.9 * kVariance_m2);
}

}  // namespace
}  // namespace lilo::core
