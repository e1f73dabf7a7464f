// SPDX-License-Identifier: BSD-3-Clause
// When a pose is uncertain against the one 10 m before.
#include "core/tracking/pose_uncertainty.hpp"
#include "tests/core/uncertain_states.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace lilo::core {
namespace {

// 1 m along each of x and y (1 sigma) after 1 s.
TEST(RecentUncertainty, IsUncertainUntilTheSensorMovedOn) {
  PoseUncertainty uncertainty(kDataWeight);
  EXPECT_FALSE(uncertainty.is_uncertain(exact_state()));
  for (int scan = 0; scan < 100; ++scan) {
    uncertainty.learn(WeakDirections{}, exact_state(), Vector6d::Constant(3.0), 0.01, true);
  }
  for (double way_m = 0.0; way_m < 13.0; way_m += 0.1) {
    if (way_m < 9.9 || way_m > 12.6) {
      EXPECT_EQ(uncertainty.is_uncertain(exact_state()), way_m < 9.9) << way_m;
    }
    uncertainty.move({0.0, -0.1, 0.0});
  }
  EXPECT_GT(uncertainty.covariance(exact_state())(3, 3), 0.9) << "the drift stays";
}

// A sensor at rest in a bare field may be so for seconds. While a direction is weak it is reported.
TEST(RecentUncertainty, AWeakDirectionAloneMakesNoPoseUncertain) {
  PoseUncertainty uncertainty(kDataWeight);
  const WeakDirections weak = weak_along(six(1.0, 0.0, 0.0, 0.0, 0.0, 0.0));
  for (int scan = 0; scan < 20; ++scan) {
    uncertainty.learn(weak, exact_state(), Vector6d::Constant(3.0), kScan_s);
  }
  EXPECT_GT(uncertainty.covariance(exact_state())(3, 3), 1.0);
  EXPECT_FALSE(uncertainty.is_uncertain(exact_state()));
}

// A keyframe of bare ground does not tell yaw. Where walls are seen again, the map knows better.
TEST(RecentUncertainty, AKeyframeMakesThePoseUncertainUnlessADirectionWasWeak) {
  for (const bool is_weak : {false, true}) {
    PoseUncertainty uncertainty(kDataWeight);
    const WeakDirections yaw = weak_along(six(0.0, 0.0, 0.0, 0.0, 0.0, 1.0));
    uncertainty.learn(is_weak ? yaw : WeakDirections{}, exact_state(), Vector6d::Ones(), kScan_s);
    const Vector6d without_yaw = six(1e-9, 1e-9, 1.0, 1e-9, 1e-9, 1e-9);
    uncertainty.add_keyframe(state_of(without_yaw), 2);
    EXPECT_EQ(uncertainty.is_uncertain(exact_state()), !is_weak) << is_weak;
    EXPECT_GT(uncertainty.covariance(exact_state())(2, 2), 1e-3);
  }
}

TEST(RecentUncertainty, WhatIsNoNumberIsUncertain) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(PoseUncertainty(kDataWeight).is_uncertain(state_of(Vector6d::Constant(none))));
}

// 1.5 degrees are 0.0262 rad: about one axis, or 0.0151 about each of three. And 0.5 m.
TEST(RecentUncertainty, IsUncertainByTheAlignmentAlone) {
  PoseUncertainty uncertainty(kDataWeight);
  const auto is_uncertain = [&](double angle_rad, double distance_m) {
    const double angle = angle_rad * angle_rad, distance = distance_m * distance_m;
    return uncertainty.is_uncertain(
        state_of(six(angle, angle, angle, distance, 1e-9, 1e-9) / kUnit / kLeastDesignEffect));
  };
  EXPECT_FALSE(is_uncertain(0.0149, 0.49));
  EXPECT_TRUE(is_uncertain(0.0153, 0.1));
  EXPECT_TRUE(is_uncertain(0.001, 0.51));
}

}  // namespace
}  // namespace lilo::core
