// SPDX-License-Identifier: BSD-3-Clause
#include "core/motion/motion_state.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <numbers>

namespace lilo::core {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
const Vector6d kDensity = Vector6d::Constant(2.0);

/// At 10 m/s along x, at the end of a scan at 5 s.
MotionState driving() {
  MotionState state;
  state.T_odom_sensor.translation_m = {3.0, 1.0, 0.0};
  state.twist.linear_mps.x() = 10.0;
  state.end_ns = 5 * kSecond_ns;
  return state;
}

ScanTiming scan_after(double gap_s) {
  const std::int64_t start_ns = 5 * kSecond_ns + static_cast<std::int64_t>(gap_s * 1e9);
  return {start_ns, start_ns + kSecond_ns / 10};
}

TEST(Predict, GoesOnAtConstantVelocity) {
  const Prior prior = predict(driving(), scan_after(0.0), kDensity, 2);
  EXPECT_NEAR(prior.T_begin.translation_m.x(), 3.0, 1e-9);
  EXPECT_NEAR(predicted_end(prior).translation_m.x(), 4.0, 1e-9);
  EXPECT_NEAR(predicted_end(prior).translation_m.y(), 1.0, 1e-9);
  EXPECT_EQ(prior.acceleration_density, kDensity);
}

TEST(Predict, KnowsLessAfterAGap) {
  const Prior next = predict(driving(), scan_after(0.0), kDensity, 2);
  const Prior late = predict(driving(), scan_after(1.0), kDensity, 2);
  EXPECT_NEAR(late.T_begin.translation_m.x(), 13.0, 1e-9);
  const KnotInformation before = next.begin_information.inverse();  // covariances
  const KnotInformation after = late.begin_information.inverse();
  for (int k = 0; k < kKnotSize; ++k) EXPECT_GT(after(k, k), before(k, k)) << k;
}

TEST(Predict, StaysWhereItWasOverALongGapOrAStepOfTheClock) {
  for (const double gap_s : {motion::kLongestGap_s + 0.1, 3600.0, -3600.0}) {
    for (const bool compensated : {false, true}) {
      ScanTiming scan = scan_after(gap_s);
      scan.motion_compensated = compensated;
      const Prior prior = predict(driving(), scan, kDensity, 2);
      EXPECT_NEAR(prior.T_begin.translation_m.x(), 3.0, 1e-9) << gap_s;
      EXPECT_NEAR(prior.span_s, 0.1, 1e-9) << gap_s;
    }
  }
}

// Looking to the left at 10 m/s, with 0.1 rad/s of roll, over 4 s: 40 m along y, 0.4 rad about y.
TEST(CovarianceOverGap, IsThatOfTheWayAtTheTwistAndOfWhiteNoise) {
  MotionState state = driving();
  state.T_odom_sensor.rotation = so3_exp({0.0, 0.0, std::numbers::pi / 2});
  state.twist.angular_radps.x() = 0.1;
  constexpr double kVelocity = 0.25;  // variance
  state.information = KnotInformation::Identity();
  state.information.bottomRightCorner<6, 6>() /= kVelocity;
  const Matrix6d C = covariance_over_gap(state, predict(state, scan_after(4.0), kDensity, 2));
  const double noise = 2.0 * 64.0 / 3.0 + 16.0 * kVelocity;
  Vector6d diagonal = Vector6d::Constant(noise);
  diagonal[1] += 0.4 * 0.4;
  diagonal[4] += 40.0 * 40.0;
  EXPECT_NEAR((C.diagonal() - diagonal).norm(), 0.0, 1e-4);
  EXPECT_NEAR(C(1, 4), 0.4 * 40.0, 1e-4);
  EXPECT_NEAR(C(3, 4), 0.0, 1e-4);
}

TEST(CovarianceOverGap, IsZeroWhereTheGapIsPredicted) {
  const Prior prior = predict(driving(), scan_after(2.4), kDensity, 2);
  EXPECT_TRUE(covariance_over_gap(driving(), prior).isZero());
  EXPECT_GT(predict(driving(), scan_after(2.6), kDensity, 2).unpredicted_s, 2.5);
  EXPECT_GT(predict(driving(), scan_after(-3.0), kDensity, 2).unpredicted_s, 2.5);
}

// All returns are those of the last firing: the trajectory begins where the last scan ended.
TEST(Predict, ReachesBackToTheLastScanWhereReturnsWereCompensated) {
  ScanTiming scan = scan_after(0.05);
  scan.motion_compensated = true;
  const Prior prior = predict(driving(), scan, kDensity, 2);
  EXPECT_NEAR(prior.T_begin.translation_m.x(), 3.0, 1e-9);
  EXPECT_NEAR(prior.span_s, 0.15, 1e-9);
}

TEST(Predict, OfTheFirstScanStandsAtTheOrigin) {
  const Prior prior = predict({}, scan_after(0.0), kDensity, 2);
  EXPECT_EQ(prior.T_begin.translation_m, Eigen::Vector3d::Zero().eval());
  EXPECT_EQ(prior.begin_information, initial_information());
  EXPECT_NEAR(prior.span_s, 0.1, 1e-9);
}

TEST(PredictedState, IsThePredictionWithLessInformation) {
  const Prior prior = predict(driving(), scan_after(0.0), kDensity, 2);
  const MotionState state = predicted_state(prior, 7);
  EXPECT_EQ(state.T_odom_sensor.translation_m, predicted_end(prior).translation_m);
  EXPECT_EQ(state.twist.linear_mps, prior.twist.linear_mps);
  EXPECT_EQ(state.end_ns, 7);
  EXPECT_LT(state.information(3, 3), prior.begin_information(3, 3));
}

TEST(ScanTiming, FollowsWhereNoFiringIsMissing) {
  const ScanTiming scan{1'000'000'000, 1'100'000'000};
  EXPECT_TRUE(scan.follows(999'950'000));
  EXPECT_FALSE(scan.follows(990'000'000));
  EXPECT_FALSE(scan.follows(2'000'000'000)) << "the clock was set back";
  EXPECT_NEAR(scan.span_s(), 0.1, 1e-12);
  EXPECT_NEAR((ScanTiming{5, 5}.span_s()), 0.1, 1e-12) << "stamps that tell nothing";
}

// Against the update of a Kalman filter, which works on covariances.
TEST(ObserveVelocity, IsTheUpdateOfAKalmanFilter) {
  Prior prior = predict(driving(), scan_after(0.0), kDensity, 2);
  prior.T_begin.rotation = so3_exp({0.0, 0.0, 0.5});
  const KnotInformation mixed = KnotInformation::Identity() + 0.1 * KnotInformation::Ones();
  prior.begin_information = mixed;
  const Eigen::Vector3d predicted_mps = prior.T_begin.rotation * prior.twist.linear_mps;
  const Eigen::Vector3d information(6.0, 1e-12, 2.0);
  KnotInformation P = mixed.inverse();
  Knot mean = Knot::Zero();
  for (const Eigen::Vector3d& observed_mps :
       {Eigen::Vector3d(1.0, 3.0, -4.0), Eigen::Vector3d(2.0, 0.0, 1.0)}) {
    observe_velocity(prior, observed_mps, information);
    const Eigen::Matrix3d R = information.cwiseInverse().asDiagonal();
    const Eigen::Matrix<double, kKnotSize, 3> gain =
        P.rightCols<3>() * (P.bottomRightCorner<3, 3>() + R).inverse();
    mean += gain * (observed_mps - predicted_mps - mean.tail<3>());
    P -= gain * P.bottomRows<3>();
  }
  EXPECT_LT((prior.begin_mean - mean).norm(), 1e-9);
  EXPECT_LT((prior.begin_information.inverse() - P).norm(), 1e-9);
}

/// Of every axis over a scan of that span, under white noise of density 2 on acceleration.
double motion_information_over(double span_s) {
  Prior prior;
  prior.span_s = span_s;
  prior.acceleration_density = kDensity;
  const Matrix6d information = motion_information(prior);
  EXPECT_TRUE(information.isApprox(information(0, 0) * Matrix6d::Identity(), 1e-9));
  return information(0, 0);
}

// Acceleration integrated twice: the variance is q T^3 / 3.
TEST(MotionInformation, IsThatOfWhiteNoiseOnAcceleration) {
  EXPECT_NEAR(motion_information_over(0.1), 3.0 / (2.0 * 1e-3), 1e-6);
  EXPECT_NEAR(motion_information_over(0.2), 3.0 / (2.0 * 8e-3), 1e-6);
}

TEST(MotionInformation, OfAShortScanIsItsPart) {
  EXPECT_NEAR(motion_information_over(0.045), 0.5 * motion_information_over(0.09), 1e-6);
  EXPECT_NEAR(motion_information_over(0.009), 0.1 * motion_information_over(0.09), 1e-6);
}

}  // namespace
}  // namespace lilo::core
