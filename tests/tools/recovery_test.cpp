// SPDX-License-Identifier: BSD-3-Clause
// The default profile where something is wrong with the scans: a pose called `tracking` is right,
// and after the trouble there are such poses again.
#include "core/odometry.hpp"
#include "tests/tools/recording.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <random>

namespace lilo {
namespace {

using test::Poses;
using test::Recording;
using test::recording_of;

constexpr double kDeg = std::numbers::pi / 180.0;

/// What happens to scan `k`; false: it never comes.
using Trouble = bool (*)(std::size_t k, Scan& scan);

bool none(std::size_t /*k*/, Scan& /*scan*/) { return true; }

bool every_fourth_missing(std::size_t k, Scan& /*scan*/) { return k % 4 != 3; }

bool a_quarter_missing(std::size_t k, Scan& /*scan*/) {
  std::minstd_rand random(static_cast<unsigned>(k) + 1);
  random.discard(5);
  return random() % 4 != 0;
}

constexpr bool is_within(std::size_t k, std::size_t first, std::size_t count) {
  return k >= first && k < first + count;
}

bool half_a_second_missing(std::size_t k, Scan& /*scan*/) { return !is_within(k, 60, 5); }

bool half_a_second_of_nothing(std::size_t k, Scan& scan) {
  if (is_within(k, 60, 5)) scan.returns.clear();
  return true;
}

bool half_a_second_twice(std::size_t k, Scan& /*scan*/) {
  return !is_within(k, 40, 5) && !is_within(k, 50, 5);
}

/// Something stands close to the sensor, left behind, from the first scan on.
bool a_quarter_blocked(std::size_t /*k*/, Scan& scan) {
  constexpr float kLeft_rad = 0.5F * std::numbers::pi_v<float>;
  std::erase_if(scan.returns, [](const Return& r) { return r.azimuth_rad > kLeft_rad; });
  return true;
}

/// It comes and goes every second.
bool a_quarter_blocked_at_times(std::size_t k, Scan& scan) {
  return k / 10 % 2 == 0 || a_quarter_blocked(k, scan);
}

struct Case {
  const char* name;
  Trouble trouble;
};
constexpr std::array kCases = {
    Case{"nothing", none},
    Case{"every fourth scan missing", every_fourth_missing},
    Case{"a quarter of scans missing", a_quarter_missing},
    Case{"half a second missing", half_a_second_missing},
    Case{"half a second of nothing", half_a_second_of_nothing},
    Case{"half a second twice", half_a_second_twice},
    Case{"a quarter blocked", a_quarter_blocked},
    Case{"a quarter blocked at times", a_quarter_blocked_at_times},
};

struct Outcome {
  int scans = 0, lost = 0;
  Poses tracked, degraded;
  int longest_without = 0;  ///< scans in a row not called tracking, after the first that was
};

/// Errors are those against the first pose called `tracking`.
Outcome run(const Recording& recording, Trouble trouble) {
  Odometry odometry{OdometryConfig{}};
  Outcome out;
  std::optional<Pose> T_world_odom;
  int without = 0;
  for (std::size_t k = 0; k < recording.scans.size(); ++k) {
    Scan scan = recording.scans[k];
    if (!trouble(k, scan)) continue;
    const Estimate e = odometry.process(scan);
    const Pose& truth = recording.truth[k];
    ++out.scans;
    const bool tracking = e.status == TrackingStatus::tracking;
    if (tracking && !T_world_odom) T_world_odom = truth * e.T_odom_sensor.inverse();
    if (!T_world_odom) continue;
    without = tracking ? 0 : without + 1;
    out.longest_without = std::max(out.longest_without, without);
    const Pose error = truth.inverse() * *T_world_odom * e.T_odom_sensor;
    if (tracking) out.tracked.add(error);
    if (e.status == TrackingStatus::degraded) out.degraded.add(error);
    if (e.status == TrackingStatus::lost) ++out.lost;
  }
  return out;
}

void print(const char* name, const Outcome& o) {
  const Poses &t = o.tracked, &d = o.degraded;
  std::printf("%-27s %4d scans, %4d tracked within %.3f m and %.2f deg, ", name, o.scans, t.count,
              t.worst_m, t.worst_rad / kDeg);
  std::printf("%2d degraded (%.3f m, %.2f deg), %d lost; not tracked: %d in a row\n", d.count,
              d.worst_m, d.worst_rad / kDeg, o.lost, o.longest_without);
}

struct Drive {
  const char* name;
  const char* world;
  sim::MotionOptions motion;
};
std::ostream& operator<<(std::ostream& out, const Drive& drive) { return out << drive.name; }

class Recovery : public testing::TestWithParam<Drive> {};

// Issue 5: tracked, or honestly not, and then found again; never a silent jump.
TEST_P(Recovery, TracksOrSaysThatItDoesNot) {
  const Recording recording = recording_of(GetParam().world, GetParam().motion);
  ASSERT_EQ(recording.scans.size(), recording.truth.size());
  for (const Case& one : kCases) {
    SCOPED_TRACE(one.name);
    const Outcome o = run(recording, one.trouble);
    print(one.name, o);
    EXPECT_LT(o.tracked.worst_m, 0.5);
    EXPECT_LT(o.tracked.worst_rad, 2.0 * kDeg);
    EXPECT_LE(o.longest_without, 10);
    EXPECT_GT(o.tracked.count, o.scans / 2);
  }
}

const Drive kDrives[] = {
    {"street", "street", {.speed_mps = 8.0, .duration_s = 12.0, .start_in_motion = true}},
    {"turning_on_the_spot",
     "street",
     {.speed_mps = 0.0, .duration_s = 12.0, .turn_rate_dps = 90.0}},
};
INSTANTIATE_TEST_SUITE_P(Simulated, Recovery, testing::ValuesIn(kDrives),
                         [](const auto& test) { return std::string(test.param.name); });

/// Poses against truth, each session by itself, when some scans are missing every five seconds.
struct Gaps {
  int count = 0;
  int found_at_once = 0;  ///< the first scan after it is tracked, or degraded
  Poses tracked;
};
Gaps run_with_gaps(const Recording& recording, std::size_t scans_missing) {
  constexpr std::size_t kEvery = 50;
  Odometry odometry{OdometryConfig{}};
  Gaps out;
  std::optional<Pose> T_world_odom;
  std::uint32_t session = 0;
  for (std::size_t k = 0; k < recording.scans.size(); ++k) {
    const std::size_t since = k % kEvery;
    if (k >= kEvery && since < scans_missing) continue;
    const Estimate e = odometry.process(recording.scans[k]);
    if (e.restarts != session) T_world_odom.reset();
    session = e.restarts;
    const bool aligned =
        e.status == TrackingStatus::tracking || e.status == TrackingStatus::degraded;
    if (k >= kEvery && since == scans_missing) {
      ++out.count;
      out.found_at_once += aligned ? 1 : 0;
    }
    if (e.status != TrackingStatus::tracking) continue;
    if (!T_world_odom) T_world_odom = recording.truth[k] * e.T_odom_sensor.inverse();
    out.tracked.add(recording.truth[k].inverse() * *T_world_odom * e.T_odom_sensor);
  }
  return out;
}

// After a second and a half at 8 m/s, in bends as well, the prediction is metres and tens of
// degrees off; the sensor is where the map knows it nevertheless.
TEST(Gap, OfASecondAndAHalfInAStreetIsBridged) {
  for (const std::uint64_t seed : {91U, 106U}) {
    const Recording recording = recording_of(
        "street", {.speed_mps = 8.0, .duration_s = 25.0, .start_in_motion = true}, seed);
    const Gaps o = run_with_gaps(recording, 15);
    std::printf("seed %d: %d of %d found at once; %d poses tracked within %.3f m, %.2f deg\n",
                static_cast<int>(seed), o.found_at_once, o.count, o.tracked.count,
                o.tracked.worst_m, o.tracked.worst_rad / kDeg);
    EXPECT_EQ(o.count, 4);
    EXPECT_GE(o.found_at_once, 3);
    EXPECT_LT(o.tracked.worst_m, 0.5);
    EXPECT_LT(o.tracked.worst_rad, 2.0 * kDeg);
  }
}

// Four seconds are too long to be sure of anything but that no wrong place is called `tracking`.
TEST(Gap, OfFourSecondsNeverEndsAtAWrongPlace) {
  const Recording recording =
      recording_of("street", {.speed_mps = 12.0, .duration_s = 25.0, .start_in_motion = true}, 91);
  const Gaps o = run_with_gaps(recording, 40);
  std::printf("%d of %d found at once; %d poses tracked within %.3f m, %.2f deg\n", o.found_at_once,
              o.count, o.tracked.count, o.tracked.worst_m, o.tracked.worst_rad / kDeg);
  EXPECT_LT(o.tracked.worst_m, 1.0);
  EXPECT_LT(o.tracked.worst_rad, 3.0 * kDeg);
}

// The sensor is switched off, carried to another street and switched on again.
TEST(Gap, ThatEndsElsewhereBeginsAnotherSession) {
  const sim::MotionOptions motion{.speed_mps = 8.0, .duration_s = 6.0, .start_in_motion = true};
  const Recording here = recording_of("street", motion, 91),
                  there = recording_of("street", motion, 92);
  Odometry odometry{OdometryConfig{}};
  for (const Scan& scan : here.scans) odometry.process(scan);
  const std::int64_t later_ns = 9'000'000'000;
  Poses tracked;
  std::optional<Pose> T_world_odom;
  for (std::size_t k = 0; k < there.scans.size(); ++k) {
    Scan scan = there.scans[k];
    scan.start_ns += later_ns;
    scan.end_ns += later_ns;
    const Estimate e = odometry.process(scan);
    if (e.restarts == 0) {
      EXPECT_EQ(e.status, TrackingStatus::lost) << "scan " << k;
    }
    if (e.status != TrackingStatus::tracking) continue;
    if (!T_world_odom) T_world_odom = there.truth[k] * e.T_odom_sensor.inverse();
    tracked.add(there.truth[k].inverse() * *T_world_odom * e.T_odom_sensor);
  }
  std::printf("%d of %zu poses tracked in the other street within %.3f m\n", tracked.count,
              there.scans.size(), tracked.worst_m);
  EXPECT_GT(tracked.count, 40);
  EXPECT_LT(tracked.worst_m, 0.2);
}

/// The first `scans` of a recording of a sensor that stands, `times` over, and then all of it.
Recording stand_longer(const Recording& recording, std::size_t scans, int times) {
  Recording out;
  const std::int64_t round_ns = recording.scans[scans].start_ns - recording.scans[0].start_ns;
  for (int round = 0; round <= times; ++round) {
    const std::size_t count = round < times ? scans : recording.scans.size();
    for (std::size_t k = 0; k < count; ++k) {
      Scan scan = recording.scans[k];
      scan.index = out.scans.size();
      scan.start_ns += round * round_ns;
      scan.end_ns += round * round_ns;
      out.scans.push_back(std::move(scan));
      out.truth.push_back(recording.truth[k]);
    }
  }
  return out;
}

// Issue 5: two minutes of standstill without drift. Ten seconds are simulated and seen thirteen
// times, which would be a drift of thirteen times theirs.
TEST(Standstill, OfTwoMinutesDoesNotDrift) {
  const Recording recording = stand_longer(
      recording_of("street", {.speed_mps = 8.0, .duration_s = 15.0, .standstill_s = 11.0}), 100,
      12);
  Odometry odometry{OdometryConfig{}};
  Poses standing, all;
  std::optional<Pose> T_world_odom;
  for (std::size_t k = 0; k < recording.scans.size(); ++k) {
    const Estimate e = odometry.process(recording.scans[k]);
    if (k < 10) continue;
    EXPECT_EQ(e.status, TrackingStatus::tracking) << "scan " << k;
    if (!T_world_odom) T_world_odom = recording.truth[k] * e.T_odom_sensor.inverse();
    const Pose error = recording.truth[k].inverse() * *T_world_odom * e.T_odom_sensor;
    if (k < 1300) standing.add(error);
    all.add(error);
  }
  std::printf("130 s of standing: %.4f m, %.3f deg; and 4 s of driving: %.3f m, %.2f deg\n",
              standing.worst_m, standing.worst_rad / kDeg, all.worst_m, all.worst_rad / kDeg);
  EXPECT_LT(standing.worst_m, 0.02);
  EXPECT_LT(standing.worst_rad, 0.1 * kDeg);
  EXPECT_GT((recording.truth.front().inverse() * recording.truth.back()).translation_m.norm(), 3.0);
  EXPECT_LT(all.worst_m, 0.1);
  EXPECT_LT(all.worst_rad, 0.5 * kDeg);
}

// Setting off on a highway behind a truck that sets off as well: for 16 beams it is most of what
// tells how far one has come. Whoever follows it must notice within a second or two.
struct Jam {
  std::uint64_t seed;
  double duration_s, still_s;  ///< another time to drive is another road, so more than is looked at
};
class Traffic : public testing::TestWithParam<Jam> {};

TEST_P(Traffic, WhoFollowsATruckNoticesAndBeginsAnew) {
  const Recording recording = recording_of(
      "highway",
      {.speed_mps = 25.0, .duration_s = GetParam().duration_s, .standstill_s = GetParam().still_s},
      GetParam().seed);
  Odometry odometry{OdometryConfig{}};
  std::optional<Pose> T_world_odom;
  std::uint32_t session = 0;
  Poses first, later;
  for (std::size_t k = 0; k < 80; ++k) {
    const Estimate e = odometry.process(recording.scans[k]);
    if (e.restarts != session) T_world_odom.reset();
    session = e.restarts;
    if (e.status != TrackingStatus::tracking) continue;
    if (!T_world_odom) T_world_odom = recording.truth[k] * e.T_odom_sensor.inverse();
    const Pose error = recording.truth[k].inverse() * *T_world_odom * e.T_odom_sensor;
    (session == 0 ? first : later).add(error);
  }
  std::printf("%u times anew; before %d poses within %.3f m, later %d within %.3f m\n", session,
              first.count, first.worst_m, later.count, later.worst_m);
  EXPECT_LE(session, 1U);
  EXPECT_LT(first.worst_m, 2.5);
  EXPECT_LT(later.worst_m, 0.2);
  EXPECT_GT(std::max(first.count, later.count), 40) << "of 80";
}

INSTANTIATE_TEST_SUITE_P(Highway, Traffic, testing::Values(Jam{21, 20.0, 0.5}, Jam{46, 12.0, 1.0}));

}  // namespace
}  // namespace lilo
