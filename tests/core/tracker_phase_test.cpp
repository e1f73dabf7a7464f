// SPDX-License-Identifier: BSD-3-Clause
// The state machine of tracker.hpp, transition by transition.
#include "core/image/feature_image.hpp"
#include "core/tracking/tracker.hpp"
#include "tests/core/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace lilo::core {
namespace {

class TrackerPhase : public testing::Test {
 protected:
  /// The yard from `T`, or whatever `scene` is, in the scan with that number.
  Estimate take(std::uint64_t index, const Pose& T = {}, const test::Scene& scene = test::yard()) {
    return take(test::scan_of(
        scene, test::even_beams(16, -15.0, 15.0), 900, [&](double) { return T; }, index));
  }
  Estimate take(const Scan& scan) {
    std::vector<Feature>& features = image_.build(scan);
    Estimate estimate = tracker_.align(scan, scan.beams, features, {});
    tracker_.update_map(features, {});
    return estimate;
  }
  /// Driving at 5 m/s. `part`: of the revolution, from its end.
  Estimate drive(std::uint64_t index, double part = 1.0) {
    const auto k = static_cast<double>(index);
    Scan scan = test::scan_of(
        test::yard(), test::even_beams(16, -15.0, 15.0), 900,
        [&](double t) {
          return Pose{Eigen::Quaterniond::Identity(), {0.5 * (k + t) - 8.0, 0.0, 0.0}};
        },
        index);
    const auto kept = static_cast<std::ptrdiff_t>(part * static_cast<double>(scan.returns.size()));
    scan.returns.erase(scan.returns.begin(), scan.returns.end() - kept);
    return take(scan);
  }
  void stand_until_tracking() {
    for (std::uint64_t k = 0; k < 10; ++k) take(k);
    ASSERT_EQ(tracker_.phase(), Phase::tracking);
  }

  Tracker tracker_{OdometryConfig{}};
  FeatureImage image_{1024, {}};
};

const test::Scene& elsewhere() {
  static const test::Scene scene = [] {
    test::Scene s;
    s.planes = {{{0.0, 0.0, 1.0}, -6.0}, {{0.0, -0.8, 0.6}, -30.0}, {{-0.8, 0.0, 0.6}, -35.0}};
    s.poles = {{25.0, 25.0, 6.0, 60.0}, {-22.0, 20.0, 4.0, 60.0}, {-30.0, -9.0, 5.0, 60.0}};
    return s;
  }();
  return scene;
}

TEST_F(TrackerPhase, StartsAndTracksAfterFourScansAtRest) {
  for (std::uint64_t k = 0; k < 3; ++k) {
    take(k);
    EXPECT_EQ(tracker_.phase(), Phase::starting) << k;
  }
  take(3);
  EXPECT_EQ(tracker_.phase(), Phase::tracking);
}

TEST_F(TrackerPhase, StartsAndTracksAfterSixScansInMotion) {
  for (std::uint64_t k = 0; k < 5; ++k) {
    EXPECT_EQ(drive(k).status, TrackingStatus::initializing) << k;
    EXPECT_EQ(tracker_.phase(), Phase::starting) << k;
  }
  EXPECT_EQ(drive(5).status, TrackingStatus::tracking);
  EXPECT_EQ(tracker_.phase(), Phase::tracking);
}

// How fast it moves there cannot be known. It shook before, and where the motion model says little,
// the little that a scan tells is not weak.
TEST_F(TrackerPhase, NeverTracksInATunnelThatItEnteredUnseen) {
  stand_until_tracking();
  for (std::uint64_t k = 10; k < 40; ++k) {
    take(k,
         {Eigen::Quaterniond::Identity(), {k % 2 == 0 ? 0.2 : 0.0, k % 3 == 0 ? 0.2 : 0.0, 0.0}});
  }
  std::mt19937 random(1);
  Estimate e;
  for (std::uint64_t k = 100; k < 140; ++k) {
    const auto path = [&](double s) {
      return Pose{Eigen::Quaterniond::Identity(), {2.0 * (static_cast<double>(k) + s), 0.0, 0.0}};
    };
    Scan scan = test::scan_of(test::tunnel(), test::even_beams(16, -15.0, 15.0), 900, path, k);
    test::add_range_noise(scan, 0.012F, random);
    e = take(scan);
    EXPECT_NE(e.status, TrackingStatus::tracking) << k;
  }
  EXPECT_EQ(e.restarts, 1U);
  EXPECT_EQ(e.status, TrackingStatus::degraded);
  EXPECT_EQ(e.weak_count, 0) << "or this test does not show what it should";
  EXPECT_FALSE(e.is_confirmed);
}

TEST_F(TrackerPhase, TracksInASecondSessionAfterItsStart) {
  for (std::uint64_t k = 0; k < 10; ++k) drive(k);
  for (std::uint64_t k = 40; k < 45; ++k) {
    const Estimate e = drive(k);
    EXPECT_EQ(e.restarts, 1U) << k;
    EXPECT_EQ(e.status, TrackingStatus::initializing) << k;
  }
  EXPECT_EQ(drive(45).status, TrackingStatus::tracking);
}

TEST_F(TrackerPhase, IsLostAfterAGapAndTracksWhereItIsFoundAgain) {
  stand_until_tracking();
  const Pose carried{so3_exp({0.0, 0.0, 0.4}), {1.2, -0.8, 0.0}};
  const Estimate e = take(20, carried);
  EXPECT_EQ(tracker_.phase(), Phase::lost);
  EXPECT_NE(e.status, TrackingStatus::lost) << "it was found";
  EXPECT_LT((e.T_odom_sensor.translation_m - carried.translation_m).norm(), 0.1);
  take(21, carried);
  EXPECT_EQ(tracker_.phase(), Phase::tracking);
  EXPECT_EQ(e.restarts, 0U);
}

TEST_F(TrackerPhase, BeginsASessionAfterTenScansInVain) {
  stand_until_tracking();
  for (std::uint64_t k = 10; k < 20; ++k) {
    const Estimate e = take(k, {}, elsewhere());
    EXPECT_EQ(e.status, TrackingStatus::lost) << k;
    EXPECT_EQ(e.restarts, 0U) << k;
  }
  EXPECT_EQ(take(20, {}, elsewhere()).restarts, 1U);
  EXPECT_EQ(tracker_.phase(), Phase::starting);
}

TEST_F(TrackerPhase, BeginsASessionAfterALongGapInMotion) {
  for (std::uint64_t k = 0; k < 12; ++k) drive(k);
  ASSERT_EQ(tracker_.phase(), Phase::tracking);
  const Estimate e = take(50, {Eigen::Quaterniond::Identity(), {3.0, 2.0, 0.0}});
  EXPECT_EQ(e.restarts, 1U);
  EXPECT_EQ(e.status, TrackingStatus::initializing);
  EXPECT_EQ(tracker_.phase(), Phase::starting);
}

TEST_F(TrackerPhase, WaitsForASensorThatStood) {
  stand_until_tracking();
  const Estimate e = take(100);
  EXPECT_EQ(e.restarts, 0U);
  EXPECT_EQ(tracker_.phase(), Phase::lost);
}

// The cover is taken off in the middle of a revolution.
TEST_F(TrackerPhase, BeginsNoSessionWithTheFragmentAfterACover) {
  for (std::uint64_t k = 0; k < 10; ++k) drive(k);
  for (std::uint64_t k = 10; k < 40; ++k) drive(k, 0.0);
  const Estimate fragment = drive(40, 0.5);
  EXPECT_EQ(fragment.status, TrackingStatus::lost);
  EXPECT_EQ(fragment.restarts, 0U);
  EXPECT_EQ(drive(41).restarts, 1U);
  EXPECT_EQ(drive(42).restarts, 1U);
}

TEST_F(TrackerPhase, BeginsAnotherSessionAfterAFragment) {
  Scan part = test::scan_of(
      test::yard(), test::even_beams(16, -15.0, 15.0), 900, [](double) { return Pose{}; }, 0);
  part.returns.resize(part.returns.size() / 12);
  std::vector<Feature> features = image_.build(part);
  tracker_.align(part, part.beams, features, {});
  tracker_.update_map(features, {});
  const Estimate e = take(1);
  EXPECT_EQ(e.restarts, 1U) << "how the sensor moved since the fragment is not known";
  EXPECT_EQ(e.status, TrackingStatus::initializing);
  take(2);
  take(3);
  EXPECT_EQ(tracker_.phase(), Phase::starting) << "counted from the first whole scan";
  take(4);
  EXPECT_EQ(tracker_.phase(), Phase::tracking);
}

}  // namespace
}  // namespace lilo::core
