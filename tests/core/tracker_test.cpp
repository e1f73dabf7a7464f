// SPDX-License-Identifier: BSD-3-Clause
#include "core/image/feature_image.hpp"
#include "core/map/cell_map.hpp"
#include "core/motion/trajectory.hpp"
#include "core/odometry.hpp"
#include "tests/core/analytic_scene.hpp"
#include "tests/core/profiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

namespace lilo {
namespace {

const BeamTable k16 = test::even_beams(16, -15.0, 15.0);
const BeamTable k64 = test::even_beams(64, -24.8, 2.0);

/// Speeding up and turning on a bumpy road: roll and pitch swing at 2 Hz.
Pose drive(double t_s, double speed_mps) {
  const double x_m = speed_mps * (t_s < 1.0 ? 0.5 * t_s * t_s : t_s - 0.5);
  const double swing = 0.004 * std::sin(12.0 * t_s) * std::min(t_s, 1.0);
  return {so3_exp({swing, -swing, 0.02 * x_m}), {x_m - 8.0, 0.05 * x_m, 0.2 * swing}};
}

struct Result {
  double worst_m = 0.0, worst_rad = 0.0;
  std::vector<Estimate> estimates;
};

Result run(const BeamTable& beams, double speed_mps, double start_s = 0.0, int scans = 25,
           bool motion_compensated = false) {
  Odometry odometry{OdometryConfig{}};
  Result result;
  Pose T_world_first;
  for (int k = 0; k < scans; ++k) {
    const double at_s = start_s + 0.1 * k;
    const auto T_world_sensor = [&](double s) {
      return drive(at_s + 0.1 * (motion_compensated ? 1.0 : s), speed_mps);
    };
    Scan scan =
        test::scan_of(test::yard(), beams, 900, T_world_sensor, static_cast<std::uint64_t>(k));
    scan.motion_compensated = motion_compensated;
    result.estimates.push_back(odometry.process(scan));
    const Pose truth = drive(at_s + 0.1, speed_mps);
    if (k == 0) T_world_first = truth;
    const Pose error = truth.inverse() * T_world_first * result.estimates.back().T_odom_sensor;
    result.worst_m = std::max(result.worst_m, error.translation_m.norm());
    result.worst_rad = std::max(result.worst_rad, so3_log(error.rotation).norm());
  }
  return result;
}

TEST(DefaultProfile, FollowsADriveWithSixteenBeams) {
  const Result result = run(k16, 6.0);
  EXPECT_LT(result.worst_m, 0.05);  // 12 m driven
  EXPECT_LT(result.worst_rad, 0.005);
  EXPECT_EQ(result.estimates.front().status, TrackingStatus::initializing);
  EXPECT_EQ(result.estimates.back().status, TrackingStatus::tracking);
}

// In one scan all returns sink, as though the sensor had come to rise at 30 m/s.
TEST(DefaultProfile, TakesNoVelocityThatNoCarrierReaches) {
  constexpr int kSinking = 15;
  Odometry odometry{OdometryConfig{}};
  for (int k = 0; k < kSinking + 5; ++k) {
    const auto at = [k](double s) {
      Pose T = drive(0.1 * (k + s), 6.0);
      if (k == kSinking) T.translation_m.z() += 1.5 * s * s;
      return T;
    };
    const Estimate e =
        odometry.process(test::scan_of(test::yard(), k16, 900, at, static_cast<std::uint64_t>(k)));
    const Pose truth = drive(0.0, 6.0).inverse() * drive(0.1 * (k + 1), 6.0);
    EXPECT_LT((truth.inverse() * e.T_odom_sensor).translation_m.norm(), 0.1) << "scan " << k;
    EXPECT_LT(e.twist.linear_mps.norm(), 7.0) << "scan " << k;
    if (k < kSinking) continue;
    EXPECT_EQ(e.status, k == kSinking ? TrackingStatus::lost : TrackingStatus::tracking) << k;
  }
}

TEST(DefaultProfile, CountsWhatAFullMapHasNoRoomFor) {
  EXPECT_EQ(run(k16, 6.0, 0.0, 3).estimates.back().map_refused_count, 0U);
  OdometryConfig config;
  config.default_profile.map_cells = 400;
  Odometry odometry{config};
  std::uint64_t refused_before = 0;
  for (std::uint64_t k = 0; k < 3; ++k) {
    const auto at = [k](double s) { return drive(0.1 * (static_cast<double>(k) + s), 6.0); };
    const Estimate e = odometry.process(test::scan_of(test::yard(), k16, 900, at, k));
    EXPECT_LE(e.map_cell_count, 2 * (400 + 100));  // fine and coarse, of ground and structure
    EXPECT_GE(e.map_refused_count, refused_before);
    refused_before = e.map_refused_count;
  }
  EXPECT_GT(refused_before, 1000U);  // a scan has thousands of points, of most of the yard
}

TEST(DefaultProfile, FollowsADriveWithSixtyFourBeams) {
  const Result result = run(k64, 6.0);
  EXPECT_LT(result.worst_m, 0.03);
  EXPECT_LT(result.worst_rad, 0.003);
}

TEST(DefaultProfile, StartsInMotion) {
  const Result result = run(k16, 8.0, 1.0, 12);
  EXPECT_LT(result.worst_m, 0.10);
  EXPECT_LT(result.worst_rad, 0.005);
}

TEST(DefaultProfile, StartsInMotionFromCompensatedScans) {
  const Result result = run(k16, 8.0, 1.0, 12, true);
  EXPECT_LT(result.worst_m, 0.02);  // 0.03 when they are straightened once more
  EXPECT_LT(result.worst_rad, 0.0005);
}

// Ground looks the same at every speed: only the posts beside the road tell.
TEST(DefaultProfile, OnAPlainRoadSaysNothingItIsNotSureOf) {
  test::Scene road;
  road.planes = {{{0.0, 0.0, 1.0}, -1.8}};
  for (int k = 0; k < 24; ++k) {
    const double along_m = -100.0 + 11.0 * k + 3.0 * std::sin(2.0 * k);
    road.poles.push_back({along_m, k % 2 == 0 ? 9.0 : -7.0, 0.25, 3.0});
  }
  const auto at = [](double t_s) {
    return Pose{Eigen::Quaterniond::Identity(), {22.0 * t_s, 0, 0}};
  };
  Odometry odometry{OdometryConfig{}};
  for (int k = 0; k < 15; ++k) {
    const Scan scan = test::scan_of(
        road, k16, 1800, [&](double s) { return at(0.1 * (k + s)); },
        static_cast<std::uint64_t>(k));
    const Estimate e = odometry.process(scan);
    if (e.status != TrackingStatus::tracking) continue;
    EXPECT_NEAR(e.twist.linear_mps.x(), 22.0, 0.7) << "scan " << k;
    EXPECT_NEAR(e.T_odom_sensor.translation_m.x(), 2.2 * k, 1.0) << "scan " << k;
  }
}

TEST(DefaultProfile, DoesNotStartFromAPieceOfATurn) {
  Odometry odometry{OdometryConfig{}};
  for (std::uint64_t k = 0; k < 4; ++k) {
    Scan scan = test::scan_of(
        test::yard(), k16, 900, [](double) { return Pose{}; }, k);
    if (k == 0) scan.returns.resize(scan.returns.size() / 12);
    const Estimate e = odometry.process(scan);
    if (k < 2) {
      EXPECT_EQ(e.status, TrackingStatus::initializing) << "scan " << k;
    }
    EXPECT_LT(e.T_odom_sensor.translation_m.norm(), 0.05) << "scan " << k;
  }
}

TEST(DefaultProfile, TwistIsThatOfTheLastFiring) {
  const Result result = run(k16, 6.0);
  const double end_s = 2.5, h = 1e-4;
  const Pose motion = drive(end_s - h, 6.0).inverse() * drive(end_s + h, 6.0);
  const Twist& twist = result.estimates.back().twist;
  // It is wrong by 0.191 to 0.214 after 22 to 28 scans.
  EXPECT_LT((twist.linear_mps - motion.translation_m / (2 * h)).norm(), 0.22);
  EXPECT_LT((twist.angular_radps - so3_log(motion.rotation) / (2 * h)).norm(), 0.05);
}

TEST(DefaultProfile, StandsStillWithoutDrift) {
  Odometry odometry{OdometryConfig{}};
  Pose settled;
  for (std::uint64_t k = 0; k < 100; ++k) {
    const Scan scan = test::scan_of(
        test::yard(), k16, 900, [](double) { return Pose{}; }, k);
    const Estimate e = odometry.process(scan);
    if (k == 10) settled = e.T_odom_sensor;
    if (k <= 10) continue;
    const Pose change = settled.inverse() * e.T_odom_sensor;
    EXPECT_LT(e.T_odom_sensor.translation_m.norm(), 0.02) << "scan " << k;
    EXPECT_LT(change.translation_m.norm(), 5e-4) << "scan " << k;
    EXPECT_LT(so3_log(change.rotation).norm(), 1e-4) << "scan " << k;
  }
}

// The process noise is the least when it sets off, and a prediction would be off by 70 mrad then.
// A swing of 3 Hz needs less freedom than shaking does: 64 beams follow it less well than 16.
TEST(DefaultProfile, SetsOffOnCobblesAfterStandingStill) {
  constexpr int kStill = 100, kMoving = 40;
  const auto at = [](double t_s) {
    const double since_s = std::max(0.0, t_s - 0.1 * kStill);
    const double swing = 0.06 * std::sin(6.0 * std::numbers::pi * since_s);  // 3.4 degrees at 3 Hz
    return Pose{so3_exp({swing, -0.7 * swing, 0.0}), {since_s - 5.0, 0.0, 0.3 * swing}};
  };
  struct Case {
    BeamTable beams;
    double most_rad;
    int least_tracking;
  };
  std::mt19937 rng(1);
  for (const auto& [beams, most_rad, least_tracking] : {Case{k16, 0.015, 30}, {k64, 0.02, 20}}) {
    Odometry odometry{OdometryConfig{}};
    int tracking = 0;
    for (int k = 0; k < kStill + kMoving; ++k) {
      Scan scan = test::scan_of(
          test::yard(), beams, 900, [&](double s) { return at(0.1 * (k + s)); },
          static_cast<std::uint64_t>(k));
      test::add_range_noise(scan, 0.02F, rng);
      const Estimate e = odometry.process(scan);
      const Pose error = at(0.1 * (k + 1)).inverse() * at(0.1) * e.T_odom_sensor;
      const double error_rad = so3_log(error.rotation).norm();
      EXPECT_LT(error.translation_m.norm(), 0.05) << beams.ring_count << " beams, scan " << k;
      EXPECT_LT(error_rad, k == kStill ? 0.025 : most_rad)
          << beams.ring_count << " beams, scan " << k;
      if (k >= kStill && e.status == TrackingStatus::tracking) ++tracking;
    }
    EXPECT_GT(tracking, least_tracking) << beams.ring_count << " beams";
  }
}

TEST(DefaultProfile, SameScansSameBits) {
  const Result a = run(k16, 5.0), b = run(k16, 5.0);
  for (std::size_t k = 0; k < a.estimates.size(); ++k) {
    const Pose &p = a.estimates[k].T_odom_sensor, &q = b.estimates[k].T_odom_sensor;
    EXPECT_EQ(p.rotation.coeffs(), q.rotation.coeffs());
    EXPECT_EQ(p.translation_m, q.translation_m);
  }
}

TEST(DefaultProfile, EmptyScansAreReportedAndTheMotionGoesOn) {
  Odometry odometry{OdometryConfig{}};
  for (int k = 0; k < 25; ++k) {
    const double at_s = 0.1 * k;
    Scan scan = test::scan_of(
        test::yard(), k16, 900, [&](double s) { return drive(at_s + 0.1 * s, 5.0); },
        static_cast<std::uint64_t>(k));
    const bool blind = k >= 15 && k < 18;
    if (blind) scan.returns.clear();
    const Estimate e = odometry.process(scan);
    const Pose truth = drive(0.1, 5.0).inverse() * drive(at_s + 0.1, 5.0);
    EXPECT_EQ(e.status == TrackingStatus::lost, blind) << "scan " << k;
    EXPECT_LT((e.T_odom_sensor.translation_m - truth.translation_m).norm(), blind ? 0.2 : 0.05);
  }
}

// Carried elsewhere while it was blind: nothing of the old map is seen again.
TEST(DefaultProfile, BeginsAnotherMapWhereTheOldOneIsOfNoUse) {
  test::Scene elsewhere;
  elsewhere.planes = {
      {{0.0, 0.0, 1.0}, -6.0}, {{0.0, -0.8, 0.6}, -30.0}, {{-0.8, 0.0, 0.6}, -35.0}};
  elsewhere.poles = {{25.0, 25.0, 6.0, 60.0}, {-22.0, 20.0, 4.0, 60.0}, {-30.0, -9.0, 5.0, 60.0}};
  Odometry odometry{OdometryConfig{}};
  std::vector<TrackingStatus> status;
  std::vector<std::uint32_t> restarts;
  Pose before, settled, last;
  for (int k = 0; k < 60; ++k) {
    const Scan scan = test::scan_of(
        k < 20 ? test::yard() : elsewhere, k16, 900,
        [&](double s) {
          return Pose{Eigen::Quaterniond::Identity(),
                      {k < 45 ? 0.0 : 0.02 * (k - 45 + s), 0.0, 0.0}};
        },
        static_cast<std::uint64_t>(k));
    const Estimate e = odometry.process(scan);
    status.push_back(e.status);
    restarts.push_back(e.restarts);
    if (k == 19) before = e.T_odom_sensor;
    if (k == 44) settled = e.T_odom_sensor;
    last = e.T_odom_sensor;
  }
  EXPECT_EQ(status[20], TrackingStatus::lost);
  EXPECT_EQ(status[44], TrackingStatus::tracking);
  // What is not joined to the old map never passes for it.
  for (std::size_t k = 20; k < status.size(); ++k) {
    const bool tracking = status[k] == TrackingStatus::tracking;
    EXPECT_TRUE(!tracking || restarts[k] == 1) << "scan " << k;
  }
  EXPECT_EQ(restarts[19], 0U);
  EXPECT_LT((settled.translation_m - before.translation_m).norm(), 0.3);
  EXPECT_NEAR((settled.inverse() * last).translation_m.x(), 0.3, 0.1);  // it follows again
}

TEST(DefaultProfile, AScanWithoutBeamsIsNoReasonToThrow) {
  Odometry odometry{OdometryConfig{}};
  EXPECT_NO_THROW(odometry.process(Scan{}));
  EXPECT_NO_THROW(odometry.process(Scan{}));
}

TEST(Trajectory, IsTheCubicThroughItsKnots) {
  core::Trajectory t;
  t.span_s = 0.1;
  t.segments = 2;
  t.knots = core::Unknowns::Zero(36);
  // d(time) = c time^3 in x: knots hold its value and derivative; between them it must come back.
  const double c = 40.0;
  for (int k = 0; k <= 2; ++k) {
    const double time_s = 0.05 * k;
    t.knots[12 * k + 3] = c * time_s * time_s * time_s;
    t.knots[12 * k + 9] = 3.0 * c * time_s * time_s;
  }
  for (double s = 0.0; s <= 1.0; s += 0.05) {
    const double time_s = 0.1 * s;
    EXPECT_NEAR(t.at(s).translation_m.x(), c * time_s * time_s * time_s, 1e-12);
  }
  EXPECT_NEAR(t.end_twist().linear_mps.x(), 3.0 * c * 0.01, 1e-9);
}

// The computer's clock is set while the robot drives: stamps jump, the sensor did not.
TEST(DefaultProfile, AStepOfTheClockBendsNothing) {
  for (const Profile profile : test::profiles()) {
    OdometryConfig config;
    config.profile = profile;
    Odometry steady(config), stepped(config);
    for (std::uint64_t k = 0; k < 16; ++k) {
      Scan scan = test::scan_of(
          test::yard(), k16, 900,
          [&](double s) { return drive(0.1 * (static_cast<double>(k) + s), 6.0); }, k);
      const Pose expected = steady.process(scan).T_odom_sensor;
      const std::int64_t step_ns = k < 6 ? 0 : k < 11 ? 3'600'000'000'000 : -1'800'000'000'000;
      scan.start_ns += step_ns;
      scan.end_ns += step_ns;
      const Pose error = expected.inverse() * stepped.process(scan).T_odom_sensor;
      EXPECT_LT(error.translation_m.norm(), 0.02) << "scan " << k;
      EXPECT_LT(so3_log(error.rotation).norm(), 0.002) << "scan " << k;
    }
  }
}

}  // namespace
}  // namespace lilo
