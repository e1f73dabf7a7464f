// SPDX-License-Identifier: BSD-3-Clause
#include "core/tracking/initializer.hpp"

#include "tests/core/observed_scan.hpp"

#include <gtest/gtest.h>

namespace lilo::core {
namespace {

constexpr std::size_t kMost = 20000;

/// Takes scans of a sensor at constant speed through the initializer, as the tracker does.
class Start {
 public:
  /// Whether the motion is known now.
  bool take(const test::Scene& scene, const std::function<Pose(double)>& motion) {
    const test::ObservedScan scan(scene, motion, index_++);
    if (initializer.add(scan.observation(), scan.features(), false, local)) return true;
    const Prior prior = local.predict(scan.timing());
    const Solution solution = initializer.scans() == 2 ? initializer.align_second(true, local)
                                                       : local.align(scan.features(), prior);
    if (initializer.scans() == 1) {
      local.accept_first(scan.timing());
    } else {
      local.accept(scan.timing(), solution);
      initializer.set_track(solution.trajectory.at(0.0), local.state().T_odom_sensor);
    }
    local.grow_map({.timing = scan.timing(), .levels = Levels::from_whole}, scan.features(),
                   solution, MapUse::keyframe);
    return false;
  }
  void skip() { ++index_; }
  /// Scans until the motion is known; 10: never.
  int scans_until_known(double speed_mps) {
    for (int k = 1; k < 10; ++k) {
      const std::uint64_t index = index_;
      if (take(test::yard(), test::along_x(speed_mps, index, -8.0))) return k;
    }
    return 10;
  }

  LocalOdometry local{DefaultConfig{}, kMost};
  Initializer initializer{kMost, 6000};

 private:
  std::uint64_t index_ = 0;
};

TEST(Initializer, FindsTheMotionOfTwoScans) {
  for (const double speed_mps : {3.0, 10.0}) {
    Start start;
    start.take(test::yard(), test::along_x(speed_mps, 0, -8.0));
    start.take(test::yard(), test::along_x(speed_mps, 1, -8.0));
    const MotionState& state = start.local.state();
    EXPECT_NEAR(state.twist.linear_mps.x(), speed_mps, 0.2);
    EXPECT_NEAR(state.T_odom_sensor.translation_m.x(), 0.1 * speed_mps, 0.03);
    EXPECT_EQ(start.initializer.assumes_stationary(), speed_mps < 5.0) << "0.3 m tell too little";
  }
}

// A scan that was dropped, or a sector that is blind where revolutions end, is way as well.
TEST(Initializer, FindsTheMotionOfTwoScansThatDoNotFollowEachOther) {
  Start start;
  start.take(test::yard(), test::along_x(10.0, 0, -8.0));
  start.skip();
  start.take(test::yard(), test::along_x(10.0, 2, -8.0));
  EXPECT_NEAR(start.local.state().twist.linear_mps.x(), 10.0, 0.2);
  EXPECT_NEAR(start.local.state().T_odom_sensor.translation_m.x(), 2.0, 0.05);
}

TEST(Initializer, KnowsAMovingStartAfterSixScansAndAStandstillAfterFour) {
  EXPECT_EQ(Start{}.scans_until_known(8.0), 6);
  EXPECT_EQ(Start{}.scans_until_known(0.0), 4);
}

TEST(Initializer, BelievesAStandstillAtOnceAndForgetsTheScansLater) {
  Start start;
  for (std::uint64_t k = 0; k < 3; ++k) {
    EXPECT_FALSE(start.take(test::yard(), test::along_x(0.0, k)));
    EXPECT_EQ(start.initializer.scans(), k + 1);
  }
  EXPECT_TRUE(start.initializer.assumes_stationary());
  EXPECT_TRUE(start.take(test::yard(), test::along_x(0.0, 3)));
  EXPECT_EQ(start.initializer.scans(), 0U);
}

// 1 m/s is 0.1 m a scan: two scans hardly tell it, and a map begun as at rest is smeared by it.
TEST(Initializer, NoticesThatTheSensorCreeps) {
  Start start;
  EXPECT_LE(start.scans_until_known(1.0), 6);
  EXPECT_NEAR(start.local.state().twist.linear_mps.x(), 1.0, 0.1);
}

TEST(Initializer, BeginsAgainAfterAFragment) {
  Start start;
  test::Scene scene = test::yard();
  start.take(scene, test::along_x(0.0, 0));
  const MotionState& state = start.local.state();
  const ScanTiming next{1'100'000'000, 1'200'000'000};
  const test::ObservedScan first(scene, test::along_x(0.0, 0), 0);
  const std::size_t count = first.features().size();
  EXPECT_FALSE(start.initializer.must_begin_again(next, count, state));
  EXPECT_TRUE(start.initializer.must_begin_again(next, 2 * count + 1, state));
  start.take(scene, test::along_x(0.0, 1));
  EXPECT_TRUE(start.initializer.must_begin_again(next, 2 * count + 1, state)) << "two fragments";
}

TEST(Initializer, BeginsAgainAfterAGapUnlessTheSensorStands) {
  for (const double speed_mps : {0.0, 8.0}) {
    Start start;
    for (std::uint64_t k = 0; k < 3; ++k) {
      start.take(test::yard(), test::along_x(speed_mps, k, -8.0));
    }
    const ScanTiming late{2'000'000'000, 2'100'000'000};
    EXPECT_EQ(start.initializer.must_begin_again(late, 1000, start.local.state()), speed_mps > 0.0);
  }
  EXPECT_FALSE(Start{}.initializer.must_begin_again({}, 1000, {})) << "before the first scan";
}

}  // namespace
}  // namespace lilo::core
