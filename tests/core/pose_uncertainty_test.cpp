// SPDX-License-Identifier: BSD-3-Clause
#include "core/tracking/pose_uncertainty.hpp"

#include "tests/core/uncertain_states.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace lilo::core {
namespace {

/// Two scans of a sensor whose acceleration is white noise of density one. The first one is
/// deskewed at the velocity from its end to the end of the second one, which is aligned with it.
/// Returns how far the points of the first one are off on average.
double error_of_first_scan(std::mt19937& rng) {
  constexpr int kSteps = 200;  // a scan
  constexpr double kStep_s = kScan_s / kSteps;
  std::normal_distribution<double> change_mps(0.0, std::sqrt(kStep_s));
  double velocity_mps = 0.0, way_m = 0.0, way_to_points_m = 0.0, first_end_m = 0.0;
  for (int step = 0; step < 2 * kSteps; ++step) {
    if (step == kSteps) first_end_m = way_m;
    if (step < kSteps) way_to_points_m += way_m / kSteps;
    velocity_mps += change_mps(rng);
    way_m += kStep_s * velocity_mps;
  }
  double error_m = 0.0;
  for (int round = 0; round < 40; ++round) {
    const double found_mps = (way_m + error_m - first_end_m) / kScan_s;
    error_m = first_end_m - way_to_points_m - 0.5 * kScan_s * found_mps;
  }
  return error_m;
}

TEST(PoseUncertainty, TheFirstScanIsAsUncertainAsTheMotionInIt) {
  constexpr int kRuns = 20000;
  std::mt19937 rng(1);
  double variance = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const double error = error_of_first_scan(rng);
    variance += error * error / kRuns;
  }
  const Vector6d density = six(1.0, 2.0, 3.0, 4.0, 5.0, 6.0);
  PoseUncertainty uncertainty(kDataWeight);
  uncertainty.learn_start(density, kScan_s);
  const Matrix6d covariance = uncertainty.covariance(exact_state());
  for (int k = 0; k < 6; ++k) {
    EXPECT_NEAR(covariance(k, k) / (density[k] * variance), 1.0, 0.05) << k;
  }
}

// Another map has a first scan of its own, and begins as uncertain as the old one was.
TEST(PoseUncertainty, TheFirstScanOfAnOlderMapCountsAsWell) {
  PoseUncertainty uncertainty(kDataWeight);
  uncertainty.learn_start(Vector6d::Ones(), kScan_s);
  const double of_one_m2 = uncertainty.covariance(exact_state())(3, 3);
  EXPECT_GT(of_one_m2, 1e-5);
  uncertainty.begin_map(exact_state());
  EXPECT_NEAR(uncertainty.covariance(exact_state())(3, 3) / of_one_m2, 1.0, 1e-9);
  uncertainty.learn_start(Vector6d::Ones(), kScan_s);
  EXPECT_NEAR(uncertainty.covariance(exact_state())(3, 3) / of_one_m2, 2.0, 1e-9);
  uncertainty.rewind();
  EXPECT_NEAR(uncertainty.covariance(exact_state())(3, 3) / of_one_m2, 1.0, 1e-9);
}

TEST(PoseUncertainty, AnAlignmentCountsByItsDesignEffect) {
  const Vector6d variance = six(1e-6, 2e-6, 3e-6, 4e-4, 5e-4, 6e-4);
  const Vector6d effect = six(1.0, 2.0, 3.0, 4.0, 5.0, 6.0);
  PoseUncertainty uncertainty(kDataWeight);
  for (int scan = 1; scan <= 30; ++scan) {
    uncertainty.learn(effect, kAllFromScan);
    // A running mean in which the newest scan has a tenth, from the least on.
    const Vector6d mean =
        effect.array() + (kLeastDesignEffect - effect.array()) * std::pow(0.9, scan);
    const Matrix6d covariance = uncertainty.covariance(state_of(variance));
    for (int k = 0; k < 6; ++k)
      EXPECT_NEAR(covariance(k, k) / (kUnit * mean[k] * variance[k]), 1.0, 1e-9) << k;
  }
}

/// The variance of x by an alignment of 1 m^2, after many scans of design effect one and these.
double variance_after(const std::vector<double>& effects) {
  PoseUncertainty uncertainty(kDataWeight);
  for (int scan = 0; scan < 1000; ++scan) uncertainty.learn(Vector6d::Ones(), kAllFromScan);
  for (const double effect : effects) {
    uncertainty.learn(Vector6d::Constant(effect), kAllFromScan);
  }
  return uncertainty.covariance(state_of(Vector6d::Ones()))(3, 3) / kUnit;
}

TEST(PoseUncertainty, AnUnusualScanCountsByItsOwnDesignEffect) {
  PoseUncertainty young(kDataWeight);
  for (int scan = 0; scan < 4; ++scan) young.learn(Vector6d::Ones(), kAllFromScan);
  young.learn(Vector6d::Constant(11.0), kAllFromScan);
  EXPECT_NEAR(young.covariance(state_of(Vector6d::Ones()))(3, 3) / kUnit, 11.0, 1e-9);
  EXPECT_NEAR(variance_after({1.8}), 1.08, 1e-9);
  EXPECT_NEAR(variance_after({11.0}), 11.0, 1e-9);  // the mean is 2 now
  EXPECT_NEAR(variance_after({11.0, 3.0}), 2.1, 1e-9);
}

// The design effect is about residuals: what the prior tells counts as it is.
TEST(PoseUncertainty, WhatThePriorTellsDoesNotCountByTheDesignEffect) {
  const Vector6d variance = six(1e-6, 2e-6, 3e-6, 4e-4, 5e-4, 6e-4);
  const Vector6d from_scan = six(0.0, 0.1, 0.25, 0.5, 0.9, 1.0);
  PoseUncertainty uncertainty(kDataWeight);
  const Vector6d data = from_scan.cwiseQuotient(variance) / kDataWeight;
  uncertainty.learn(Vector6d::Zero(), data.asDiagonal());
  const Matrix6d covariance = uncertainty.covariance(state_of(variance));
  for (int k = 0; k < 6; ++k) {
    const double part = 1.0 - from_scan[k] + from_scan[k] * kUnit * kLeastDesignEffect;
    EXPECT_NEAR(covariance(k, k) / (part * variance[k]), 1.0, 1e-9) << k;
  }
}

TEST(PoseUncertainty, ASimulationWithoutNoiseIsNoReasonToBeSure) {
  PoseUncertainty uncertainty(kDataWeight);
  for (int scan = 0; scan < 1000; ++scan) uncertainty.learn(Vector6d::Zero(), kAllFromScan);
  const Matrix6d covariance = uncertainty.covariance(state_of(Vector6d::Constant(1e-4)));
  EXPECT_NEAR(covariance(3, 3), kUnit * kLeastDesignEffect * 1e-4, 1e-12);
}

TEST(PoseUncertainty, IsInTheSensorsAxes) {
  MotionState state = state_of(six(1e-6, 1e-6, 1e-6, 9e-4, 1e-4, 1e-4));
  state.T_odom_sensor.rotation = kLeft;
  const Matrix6d covariance = PoseUncertainty(kDataWeight).covariance(state);
  EXPECT_NEAR(covariance(4, 4) / covariance(3, 3), 9.0, 1e-9);  // odometry's x is on its right
}

// Of a keyframe's standard error a thirteenth is handed on, and half as much again is correlated.
TEST(PoseUncertainty, AKeyframeHandsOnItsError) {
  const MotionState aligned = state_of(Vector6d::Constant(1e-4));
  const double alignment = kUnit * kLeastDesignEffect * 1e-4;
  PoseUncertainty old_map(kDataWeight), young_map(kDataWeight);
  old_map.add_keyframe(aligned, kOldMap);
  young_map.add_keyframe(aligned, 2);  // as much as the first one
  const auto part_of = [&](const PoseUncertainty& uncertainty) {
    return uncertainty.covariance(exact_state())(3, 3) / alignment;
  };
  EXPECT_NEAR(part_of(old_map), 1.25 / (13.0 * 13.0), 1e-9);
  EXPECT_NEAR(part_of(young_map), 1.25 / (2.0 * 2.0), 1e-9);
}

TEST(PoseUncertainty, AnotherMapBeginsAsUncertainAsThePoseWas) {
  PoseUncertainty uncertainty(kDataWeight);
  const double yaw = 1e-4 / (kUnit * kLeastDesignEffect);  // 0.01 rad, 1 sigma
  uncertainty.begin_map(state_of(six(1e-18, 1e-18, yaw, 1e-18, 1e-18, 1e-18)));
  const Matrix6d at_start = uncertainty.covariance(exact_state());
  EXPECT_NEAR(at_start(2, 2), 1e-4, 1e-12);
  EXPECT_NEAR(at_start(4, 4), 0.0, 1e-12);
  uncertainty.move({100.0, 0.0, 0.0});
  const Matrix6d ahead = uncertainty.covariance(exact_state());
  EXPECT_NEAR(ahead(4, 4), 1.0, 1e-9);          // 0.01 rad of 100 m
  EXPECT_NEAR(ahead(3, 3), 0.03 * 0.03, 1e-9);  // the scale: 3e-4 of the way
  uncertainty.rewind();
  EXPECT_TRUE(uncertainty.covariance(exact_state()).isApprox(at_start));
}

// Residuals that agree make an alignment more certain than its information says, not a prediction.
TEST(PoseUncertainty, APredictionAddsAllThatTheStateLoses) {
  const Matrix6d no_gap = Matrix6d::Zero();
  const MotionState aligned = state_of(Vector6d::Constant(1e-6));
  PoseUncertainty uncertainty(kDataWeight);
  uncertainty.learn(Vector6d::Constant(kLeastDesignEffect), kAllFromScan);
  const double before = uncertainty.covariance(aligned)(3, 3);
  EXPECT_LT(before, 0.1 * 1e-6);
  uncertainty.predict(aligned, no_gap);
  const MotionState predicted = state_of(Vector6d::Constant(5e-6));
  EXPECT_NEAR(uncertainty.covariance(predicted)(3, 3), before + 4e-6, 1e-12);
  uncertainty.predict(predicted, no_gap);  // and the next one is not aligned either
  const MotionState later = state_of(Vector6d::Constant(9e-6));
  EXPECT_NEAR(uncertainty.covariance(later)(3, 3), before + 8e-6, 1e-12);
  uncertainty.learn(Vector6d::Constant(kLeastDesignEffect), kAllFromScan);
  EXPECT_NEAR(uncertainty.covariance(aligned)(3, 3), before, 1e-12) << "aligned again";
  uncertainty.predict(aligned, Matrix6d::Identity());
  EXPECT_GT(uncertainty.covariance(aligned)(3, 3), 1.0);
  uncertainty.rewind();
  EXPECT_NEAR(uncertainty.covariance(aligned)(3, 3), before, 1e-12) << "the same map once more";
}

TEST(PoseUncertainty, NoRotationIsLessKnownThanAnUnknownOne) {
  PoseUncertainty uncertainty(kDataWeight);
  const MotionState state = state_of(Vector6d::Constant(1e-6));
  uncertainty.predict(state, six(100.0, 0.0, 1.0, 100.0, 0.0, 0.0).asDiagonal());
  uncertainty.begin_map(state);  // and another gap after that
  uncertainty.predict(state, six(100.0, 0.0, 0.0, 0.0, 0.0, 0.0).asDiagonal());
  const Matrix6d after = uncertainty.covariance(state);
  EXPECT_NEAR(after(0, 0), std::numbers::pi * std::numbers::pi / 3.0, 1e-6);
  EXPECT_NEAR(after(2, 2), 1.0, 1e-4);
  EXPECT_NEAR(after(3, 3), 100.0, 1e-3);
}

// The velocity is tied to the pose, so that the state's covariance falls along one direction.
TEST(PoseUncertainty, APredictionStaysPositive) {
  PoseUncertainty uncertainty(kDataWeight);
  uncertainty.learn(Vector6d::Constant(kLeastDesignEffect), kAllFromScan);
  uncertainty.predict(state_of(Vector6d::Constant(4e-6)), Matrix6d::Zero());
  const Matrix6d after = uncertainty.covariance(state_of(six(1e-6, 9e-6, 9e-6, 1e-6, 9e-6, 9e-6)));
  EXPECT_GT(after.diagonal().minCoeff(), 0.0);
}

// A position under white noise q on acceleration is uncertain by q t^3 / 3.
TEST(PoseUncertainty, AnUnseenDirectionIsDeadReckoned) {
  constexpr double kShortScan_s = 0.01;
  const Vector6d density = six(0.3, 0.3, 0.3, 2.0, 4.0, 100.0);  // 3 on the ground plane
  MotionState state = exact_state();
  state.T_odom_sensor.rotation = kLeft;
  PoseUncertainty uncertainty(kDataWeight);
  for (int scan = 0; scan < 1000; ++scan)
    uncertainty.learn(weak_along(six(1.0, 0.0, 0.0, 0.0, 0.0, 0.0)), state, density, kShortScan_s);
  const Matrix6d of_sensor = uncertainty.covariance(state);
  EXPECT_NEAR(of_sensor(3, 3) / (3.0 * 1000.0 / 3.0), 1.0, 0.01);
  EXPECT_NEAR(of_sensor(4, 4), 0.0, 1e-9);
  // To the odometry, ahead of that sensor is y.
  const Matrix6d of_odometry = uncertainty.covariance(exact_state());
  EXPECT_NEAR(of_odometry(4, 4), of_sensor(3, 3), 1e-9);
}

TEST(PoseUncertainty, EveryUnseenDirectionIsDeadReckoned) {
  PoseUncertainty uncertainty{kDataWeight};
  WeakDirections weak;
  weak.count = 3;
  weak.all[0].direction = six(0.0, 0.0, 0.0, 1.0, 0.0, 0.0);  // a round pipe does not tell roll
  weak.all[1].direction = six(1.0, 0.0, 0.0, 0.0, 0.0, 0.0);
  weak.all[2].direction = six(0.0, 1.0, 0.0, 0.0, 0.0, 0.0);
  const Matrix6d before = uncertainty.covariance(exact_state());
  for (int k = 0; k < 10; ++k) uncertainty.learn(weak, exact_state(), Vector6d::Ones(), 0.1);
  const Matrix6d after = uncertainty.covariance(exact_state());
  // q t^3 / 3 after 1 s; sums of ten steps are coarse.
  for (const int axis : {3, 4}) EXPECT_NEAR(after(axis, axis) - before(axis, axis), 1.0 / 3.0, 0.1);
  EXPECT_NEAR(after(5, 5), before(5, 5), 1e-9);
}

// Of x the scan tells next to nothing, of y it gives a third.
TEST(PoseUncertainty, OnlyADirectionOfWhichTheScanTellsNextToNothingIsDeadReckoned) {
  PoseUncertainty uncertainty(kDataWeight);
  WeakDirections weak;
  weak.count = 2;
  weak.all[0] = {.direction = six(1.0, 0.0, 0.0, 0.0, 0.0, 0.0), .from_scan = 0.05};
  weak.all[1] = {.direction = six(0.0, 1.0, 0.0, 0.0, 0.0, 0.0), .from_scan = 1.0 / 3.0};
  uncertainty.learn(weak, exact_state(), Vector6d::Ones(), 0.1);
  const Matrix6d covariance = uncertainty.covariance(exact_state());
  EXPECT_NEAR(covariance(3, 3), 1e-3, 1e-9);  // q t^2 dt of one scan
  EXPECT_NEAR(covariance(4, 4), 0.0, 1e-12);
}

// Dead reckoning goes on after it: the velocity is no better known. A scan that tells of all
// translations ends it.
TEST(PoseUncertainty, AScanThatGivesAThirdRestoresNoVelocity) {
  const auto grown_after = [&](const WeakDirections& between) {
    PoseUncertainty uncertainty(kDataWeight);
    const WeakDirections unseen = weak_along(six(1.0, 0.0, 0.0, 0.0, 0.0, 0.0));
    for (const WeakDirections& scan : {unseen, between, unseen}) {
      uncertainty.learn(scan, exact_state(), Vector6d::Ones(), kScan_s);
    }
    return uncertainty.covariance(exact_state())(3, 3);
  };
  WeakDirections third = weak_along(six(1.0, 0.0, 0.0, 0.0, 0.0, 0.0));
  third.all[0].from_scan = 1.0 / 3.0;
  EXPECT_NEAR(grown_after(third), (1.0 + 4.0) * 1e-3, 1e-9);
  EXPECT_NEAR(grown_after(WeakDirections{}), (1.0 + 1.0) * 1e-3, 1e-9);
}

// A scan in which the sensor may have pitched as it rose. Where the rise is free, pitch has its own
// noise, and the other way round. Where both are as noisy, so is the motion.
TEST(PoseUncertainty, DeadReckoningThatTurnsIsAsLittleFreeAsTheRotation) {
  constexpr double kPitch = 0.8, kRise = 0.6;
  const auto grown_with = [](double pitch_density, double rise_density) -> Matrix6d {
    PoseUncertainty uncertainty(kDataWeight);
    const Matrix6d before = uncertainty.covariance(exact_state());
    uncertainty.learn(weak_along(six(0.0, 0.0, kRise, 0.0, kPitch, 0.0)), exact_state(),
                      six(pitch_density, pitch_density, 1.0, 1.0, 1.0, rise_density), kScan_s);
    return uncertainty.covariance(exact_state()) - before;
  };
  EXPECT_NEAR(grown_with(0.3, 1e9)(1, 1), 0.3e-3, 1e-9);
  EXPECT_NEAR(grown_with(1e9, 30.0)(5, 5), 30e-3, 1e-8);
  const Matrix6d alike = grown_with(2.0, 2.0);
  EXPECT_NEAR(alike(1, 1) + alike(5, 5), 2e-3, 1e-9);
  EXPECT_NEAR(alike(1, 1) / alike(5, 5), kPitch * kPitch / (kRise * kRise), 1e-6);
}

// What the scans were aligned with may have moved along the ground in any direction.
TEST(PoseUncertainty, WhereTrafficMayBeFollowedTheMotionAlongTheGroundIsDeadReckoned) {
  constexpr double kShortScan_s = 0.01;
  const Vector6d density = six(0.3, 0.3, 0.3, 2.0, 4.0, 100.0);  // 3 on the ground plane
  PoseUncertainty uncertainty(kDataWeight);
  for (int scan = 0; scan < 100; ++scan) {
    uncertainty.learn(WeakDirections{}, exact_state(), density, kShortScan_s, true);
  }
  const Matrix6d covariance = uncertainty.covariance(exact_state());
  for (const int axis : {3, 4}) EXPECT_NEAR(covariance(axis, axis), 1.0, 0.03);  // q t^3 / 3
  EXPECT_NEAR(covariance(5, 5), 0.0, 1e-9);
}

// Of y the scans tell a hundredth of what they tell of any other direction, or less. That is more
// than the motion model does where no translation is weak, as on stairs.
TEST(PoseUncertainty, AlongTheDirectionOfADegenerateScanTheMotionIsDeadReckoned) {
  WeakDirections third = weak_along(six(0.0, 1.0, 0.0, 0.0, 0.0, 0.0));
  third.all[0].from_scan = 1.0 / 3.0;
  const auto grown_with = [](double along_y, const WeakDirections& weak) -> Matrix6d {
    PoseUncertainty uncertainty(kDataWeight);
    uncertainty.learn(Vector6d::Zero(), six(1e9, 1e9, 1e9, 1e9, along_y, 1e9).asDiagonal());
    const Matrix6d before = uncertainty.covariance(exact_state());
    uncertainty.learn(weak, exact_state(), Vector6d::Constant(2.0), kScan_s);
    return uncertainty.covariance(exact_state()) - before;
  };
  const Matrix6d grown = grown_with(0.9e7, third);
  EXPECT_NEAR(grown(4, 4), 2e-3, 1e-9);  // q t^2 dt of one scan
  EXPECT_NEAR(grown.trace(), grown(4, 4), 1e-9);
  EXPECT_NEAR(grown_with(1.1e7, third).trace(), 0.0, 1e-9);
  EXPECT_NEAR(grown_with(0.9e7, WeakDirections{}).trace(), 0.0, 1e-9);
}

TEST(PoseUncertainty, WeaknessThatMostlyTurnsIsNotDeadReckoned) {
  PoseUncertainty uncertainty(kDataWeight);
  const Vector6d density = Vector6d::Ones();
  uncertainty.learn(weak_along(six(0.28, 0.0, 0.0, 0.0, 0.0, 0.96)), exact_state(), density, 0.1);
  uncertainty.learn(WeakDirections{}, exact_state(), density, 0.1);
  EXPECT_NEAR(uncertainty.covariance(exact_state())(3, 3), 0.0, 1e-12);
}

}  // namespace
}  // namespace lilo::core
