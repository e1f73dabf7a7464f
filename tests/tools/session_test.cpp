// SPDX-License-Identifier: BSD-3-Clause
// The default profile where the motion or the place changes at once: followed, or another session;
// no pose called `tracking` is wrong, and no state lasts.
#include "core/odometry.hpp"
#include "tests/tools/recording.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <optional>

namespace lilo {
namespace {

using test::Poses;
using test::Recording;
using test::recording_of;

constexpr double kDeg = std::numbers::pi / 180.0;

/// Poses called `tracking` against truth, each session by itself.
struct Sessions {
  std::uint32_t restarts = 0;
  int scans_until_restart = 0;  ///< of those given since the trouble
  Poses tracked, tracked_after, degraded;
};

class SessionRun {
 public:
  void see(const Scan& scan, const Pose& truth, bool is_after) {
    const Estimate e = odometry_.process(scan);
    if (e.restarts != out_.restarts) T_world_odom_.reset();
    out_.restarts = e.restarts;
    if (is_after && e.restarts == 0) ++out_.scans_until_restart;
    const bool is_tracking = e.status == TrackingStatus::tracking;
    if (is_tracking && !T_world_odom_) T_world_odom_ = truth * e.T_odom_sensor.inverse();
    if (!T_world_odom_) return;
    const Pose error = truth.inverse() * *T_world_odom_ * e.T_odom_sensor;
    if (e.status == TrackingStatus::degraded) out_.degraded.add(error);
    if (!is_tracking) return;
    out_.tracked.add(error);
    if (is_after) out_.tracked_after.add(error);
  }
  [[nodiscard]] const Sessions& out() const { return out_; }

 private:
  Odometry odometry_{OdometryConfig{}};
  std::optional<Pose> T_world_odom_;
  Sessions out_;
};

Sessions run_with_gap(const Recording& recording, std::size_t first_missing, std::size_t missing) {
  SessionRun run;
  for (std::size_t k = 0; k < recording.scans.size(); ++k) {
    if (k >= first_missing && k < first_missing + missing) continue;
    run.see(recording.scans[k], recording.truth[k], k >= first_missing);
  }
  return run.out();
}

Sessions run_whole(const Recording& recording) {
  return run_with_gap(recording, recording.scans.size(), 0);
}

// Ten seconds at 8 m/s lead farther than anything in the old map can tell.
TEST(Gap, OfTenSecondsWhileDrivingBeginsAnotherSessionAtOnce) {
  for (const std::uint64_t seed : {91U, 106U}) {
    const Recording recording = recording_of(
        "street", {.speed_mps = 8.0, .duration_s = 20.0, .start_in_motion = true}, seed);
    const Sessions o = run_with_gap(recording, 40, 100);
    EXPECT_EQ(o.restarts, 1U);
    EXPECT_EQ(o.scans_until_restart, 0);
    EXPECT_GT(o.tracked_after.count, 40);
    EXPECT_LT(o.tracked.worst_m, 0.2);
    EXPECT_LT(o.tracked.worst_rad, 1.0 * kDeg);
  }
}

TEST(Gap, OfTenSecondsWhileStandingKeepsTheSession) {
  const Recording recording =
      recording_of("street", {.speed_mps = 8.0, .duration_s = 18.0, .standstill_s = 15.5}, 91);
  const Sessions o = run_with_gap(recording, 40, 100);
  EXPECT_EQ(o.restarts, 0U);
  EXPECT_GT(o.tracked_after.count, 35);
  EXPECT_LT(o.tracked.worst_m, 0.1);
}

// From one scan to the next everything is another: the map is not defended.
TEST(Splice, WithAnotherPlaceBeginsAnotherSessionWithinTwoSeconds) {
  const sim::MotionOptions motion{.speed_mps = 8.0, .duration_s = 6.0, .start_in_motion = true};
  for (const char* world : {"street", "park"}) {
    SCOPED_TRACE(world);
    const Recording here = recording_of("street", motion, 91),
                    there = recording_of(world, motion, 92);
    const std::int64_t shift_ns = here.scans.back().end_ns - there.scans.front().start_ns;
    SessionRun run;
    for (std::size_t k = 0; k < here.scans.size(); ++k) {
      run.see(here.scans[k], here.truth[k], false);
    }
    for (std::size_t k = 0; k < there.scans.size(); ++k) {
      Scan scan = there.scans[k];
      scan.start_ns += shift_ns;
      scan.end_ns += shift_ns;
      // The first truth of the other place is no pose of this one.
      run.see(scan, Pose{{1.0, 0.0, 0.0, 0.0}, {1000.0, 0.0, 0.0}} * there.truth[k], true);
    }
    const Sessions& o = run.out();
    std::printf("%d scans until another session; %d poses tracked there within %.3f m\n",
                o.scans_until_restart, o.tracked_after.count, o.tracked_after.worst_m);
    EXPECT_EQ(o.restarts, 1U);
    EXPECT_LE(o.scans_until_restart, 20);
    EXPECT_GT(o.tracked_after.count, 25);
    EXPECT_LT(o.tracked.worst_m, 0.3);
  }
}

// Nearly all that is seen is ground. What little structure there is fits by chance or not at all.
TEST(Hills, ThatAreBareAreOneSession) {
  for (const std::uint64_t seed : {21U, 22U, 24U}) {
    SCOPED_TRACE(seed);
    const Recording recording = recording_of("hills", {.speed_mps = 6.0, .duration_s = 20.0}, seed);
    const Sessions o = run_whole(recording);
    std::printf("hills %d: %d tracked within %.3f m; %d degraded, %.3f m, %.2f deg\n",
                static_cast<int>(seed), o.tracked.count, o.tracked.worst_m, o.degraded.count,
                o.degraded.worst_m, o.degraded.worst_rad / kDeg);
    EXPECT_EQ(o.restarts, 0U);
    EXPECT_GT(o.tracked.count + o.degraded.count, 150);  // from the first one tracked on
    EXPECT_LT(std::max(o.tracked.worst_m, o.degraded.worst_m), 1.0);
    EXPECT_LT(std::max(o.tracked.worst_rad, o.degraded.worst_rad), 3.0 * kDeg);
  }
}

// By chance some of the structure shares cells under many a motion, and the true one has to be
// found in the ground.
TEST(Hills, AreFollowedByASensorThatStartsInMotion) {
  for (const std::uint64_t seed : {2U, 5U, 6U}) {
    const Recording recording =
        recording_of("hills", {.speed_mps = 8.0, .duration_s = 8.0, .start_in_motion = true}, seed);
    Odometry odometry{OdometryConfig{}};
    constexpr std::size_t kFrom = 10;  // scans, a second
    Estimate from, last;
    for (std::size_t k = 0; k < recording.scans.size(); ++k) {
      last = odometry.process(recording.scans[k]);
      if (k == kFrom) from = last;
    }
    const Pose moved = from.T_odom_sensor.inverse() * last.T_odom_sensor;
    const Pose truth = recording.truth[kFrom].inverse() * recording.truth.back();
    const double error_m = (truth.inverse() * moved).translation_m.norm();
    std::printf("hills %d: %.3f m off after %.1f m\n", static_cast<int>(seed), error_m,
                truth.translation_m.norm());
    EXPECT_EQ(last.restarts, 0U) << seed;
    EXPECT_LT(error_m, 1.0) << seed;
  }
}

// A turntable at full speed within one scan: 9 to 36 degrees from each scan to the next.
TEST(Spin, BegunWithinAScanIsFollowed) {
  for (const double rate_dps : {90.0, -180.0, 360.0}) {
    for (const char* world : {"park", "field"}) {
      SCOPED_TRACE(world);
      const Recording recording = recording_of(world, {.speed_mps = 0.0,
                                                       .duration_s = 6.0,
                                                       .standstill_s = 1.5,
                                                       .turn_rate_dps = rate_dps,
                                                       .turn_ramp_s = 0.1});
      const Sessions o = run_whole(recording);
      std::printf("%s, %.0f deg/s: %d tracked within %.3f m, %.2f deg; %d degraded, %.2f deg\n",
                  world, rate_dps, o.tracked.count, o.tracked.worst_m, o.tracked.worst_rad / kDeg,
                  o.degraded.count, o.degraded.worst_rad / kDeg);
      EXPECT_EQ(o.restarts, 0U);
      EXPECT_GT(o.tracked.count, 20);
      EXPECT_LT(o.tracked.worst_m, 0.1);
      EXPECT_LT(o.tracked.worst_rad, 3.0 * kDeg);  // beyond it a pose is wrong: tools/README.md
      EXPECT_LT(o.degraded.worst_rad, 10.0 * kDeg);
    }
  }
}

}  // namespace
}  // namespace lilo
