// SPDX-License-Identifier: BSD-3-Clause
// The process noise is estimated from the motion, and a motion that was not expected is followed.
#include "core/motion/process_noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace lilo::core {
namespace {

constexpr std::int64_t kScan_ns = 100'000'000;
const Vector6d kExact = Vector6d::Zero();  // variance of a pose

Vector6d nominal() {
  Vector6d density;
  density << 0.3, 0.3, 0.3, 3.0, 3.0, 3.0;
  return density;
}

/// What comes of 30 s of scans whose middle is at `pose_at(seconds)`.
template <typename PoseAt>
Vector6d density_after(ProcessNoise& noise, const PoseAt& pose_at) {
  for (std::int64_t scan = 0; scan < 300; ++scan) {
    const std::int64_t stamp_ns = scan * kScan_ns;
    noise.observe(pose_at(1e-9 * static_cast<double>(stamp_ns)), stamp_ns, kExact);
  }
  return noise.density();
}

TEST(ProcessNoise, OfASteadyMotionIsTheNominal) {
  ProcessNoise noise(nominal());
  const Vector6d density = density_after(noise, [](double t_s) {
    return Pose{so3_exp({0.0, 0.0, 0.4 * t_s}), {12.0 * t_s, 0.0, 0.1 * t_s}};
  });
  EXPECT_EQ(density, nominal());
}

// A rate of 30 deg/s rms, new in every scan: mean velocities over adjacent intervals differ by
// twice its variance, so that q is 3/2 of that over T.
TEST(ProcessNoise, GrowsWithTheMotionOfItsOwnAxesOnly) {
  constexpr double kRate_radps = std::numbers::pi / 6.0, kT_s = 0.1;
  ProcessNoise noise(nominal());
  std::mt19937 rng(1);
  std::normal_distribution<double> normal;
  double pitch_rad = 0.0;
  double sum = 0.0;
  for (std::int64_t scan = 0; scan < 5000; ++scan) {
    pitch_rad += kT_s * kRate_radps * normal(rng);
    noise.observe({so3_exp({0.0, pitch_rad, 0.0}), Eigen::Vector3d::Zero()}, scan * kScan_ns,
                  kExact);
    if (scan >= 1000) sum += noise.density()[1] / 4000.0;
  }
  // Of two axes that share their noise one moves.
  const double white = 1.5 * 2.0 * kRate_radps * kRate_radps / kT_s / 2.0;
  // It counts sixteen times, since what shakes faster cancels in part from scan to scan.
  EXPECT_NEAR(sum / white, 16.0, 1.0);
  EXPECT_EQ(noise.density()[0], noise.density()[1]);
  EXPECT_EQ(noise.density().tail<4>(), nominal().tail<4>());
}

// The velocity changes by 0.1, 0.2, 0.3, 0.4 and 0.5 m/s from scan to scan, and by more later on: q
// is 3/2 of the mean square of five over T, and half of that for two axes that share their noise.
// The second map begins elsewhere, which is no motion.
TEST(ProcessNoise, RemembersTheFirstFiveChangesOfTheMotion) {
  constexpr double kT_s = 0.1, kMeanSquare = (0.01 + 0.04 + 0.09 + 0.16 + 0.25) / 5.0;
  ProcessNoise noise(nominal());
  EXPECT_EQ(noise.density_at_start(), Vector6d::Zero());
  std::int64_t scan = 0;
  for (int map = 0; map < 2; ++map) {
    double x_m = 100.0 * map, velocity_mps = 0.0;
    for (int change = 0; change <= 20; ++change, ++scan) {
      noise.observe({Eigen::Quaterniond::Identity(), {x_m, 0.0, 0.0}}, scan * kScan_ns, kExact);
      velocity_mps += 0.1 * change;
      x_m += kT_s * velocity_mps;
    }
    EXPECT_NEAR(noise.density_at_start()[3], 0.5 * 1.5 * kMeanSquare / kT_s, 1e-6) << map;
    EXPECT_EQ(noise.density_at_start()[5], 0.0);
    noise.begin_map();
    EXPECT_EQ(noise.density_at_start(), Vector6d::Zero());
  }
}

// The last two scans slip back along the road, so that the velocity changes by 5 m/s twice. Each
// change counts as eight times the estimate, with a weight of a tenth.
TEST(ProcessNoise, ASlipLeavesTheNextScansLittleFreedom) {
  ProcessNoise noise(nominal());
  density_after(noise, [](double t_s) {
    const double slipped_m = std::clamp(10.0 * (t_s - 29.75), 0.0, 2.0);
    return Pose{so3_exp(Eigen::Vector3d::Zero()), {20.0 * t_s - slipped_m, 0.0, 0.0}};
  });
  EXPECT_NEAR(noise.density()[3], 3.0 * 1.7 * 1.7, 1e-9);
}

// The yaw rate changes by 0.5 rad/s with the last scan: q is 3/2 of its square over T, and counts
// sixteen times, with a weight of a tenth.
TEST(ProcessNoise, AnAbruptTurnCountsInFull) {
  ProcessNoise noise(nominal());
  density_after(noise, [](double t_s) {
    return Pose{so3_exp({0.0, 0.0, std::max(0.0, t_s - 29.85)}), Eigen::Vector3d::Zero()};
  });
  EXPECT_NEAR(noise.density()[2], 0.9 * 0.3 + 0.1 * 16.0 * 1.5 * 0.25 / 0.1, 1e-6);
}

TEST(ProcessNoise, CalmsDownWithTheMotion) {
  ProcessNoise noise(nominal());
  density_after(noise, [](double t_s) {
    return Pose{so3_exp({0.05 * std::sin(20.0 * t_s), 0.0, 0.0}), Eigen::Vector3d::Zero()};
  });
  EXPECT_GT(noise.density()[0], 2.0 * nominal()[0]);
  noise.interrupt();
  density_after(noise, [](double) { return Pose{}; });
  EXPECT_EQ(noise.density(), nominal());
}

// Returns that were compensated for the motion tell none.
TEST(ProcessNoise, IsTheSameForTheReportedPoseWhereNothingIsObserved) {
  ProcessNoise noise(nominal());
  EXPECT_EQ(noise.reported_density(), nominal());
  noise.observe({}, 0, kExact);
  noise.observe({}, kScan_ns, kExact);
  EXPECT_EQ(noise.reported_density(), nominal()) << "one velocity is no change";
  noise.observe({}, 2 * kScan_ns, kExact);
  EXPECT_LT(noise.reported_density()[2], nominal()[2]);
}

// A steady motion leaves the reported rotation a tenth of the nominal density.
TEST(ProcessNoise, TheReportedRotationMayBeCalmerThanTheNominal) {
  ProcessNoise noise(nominal());
  density_after(noise, [](double t_s) {
    return Pose{so3_exp({0.0, 0.0, 0.4 * t_s}), {12.0 * t_s, 0.0, 0.0}};
  });
  EXPECT_NEAR((noise.reported_density().head<3>() - 0.1 * nominal().head<3>()).norm(), 0.0, 1e-6);
  EXPECT_EQ(noise.reported_density().tail<3>(), nominal().tail<3>());
}

// A yaw rate of 0.5 rad/s and back, scan by scan, is far more than the nominal density. Three times
// as much counts for the reported pose.
TEST(ProcessNoise, TheReportedRotationShakesFasterThanTheScans) {
  ProcessNoise noise(nominal());
  density_after(noise, [](double t_s) {
    const bool is_odd = std::lround(10.0 * t_s) % 2 == 1;
    return Pose{so3_exp({0.0, 0.0, is_odd ? 0.05 : 0.0}), Eigen::Vector3d::Zero()};
  });
  EXPECT_GT(noise.density()[2], 10.0 * nominal()[2]);
  EXPECT_NEAR(noise.reported_density()[2] / noise.density()[2], 3.0, 1e-6);
  EXPECT_NEAR(noise.reported_density()[0], 0.1 * nominal()[0], 1e-9);
}

// A pose put right, a new map or a gap is no motion.
TEST(ProcessNoise, DoesNotTakeAJumpAcrossAnInterruptionForMotion) {
  ProcessNoise noise(nominal());
  Pose there{so3_exp({0.5, 0.2, 1.0}), {7.0, 8.0, 9.0}};
  density_after(noise, [](double) { return Pose{}; });
  noise.interrupt();
  density_after(noise, [&](double) { return there; });
  EXPECT_EQ(noise.density(), nominal());
  noise.observe({}, 300 * kScan_ns + 2'000'000'000, kExact);
  EXPECT_EQ(noise.density(), nominal());
}

// Along a tunnel a scan hardly tells the way. What its error makes of the velocity is no motion.
TEST(ProcessNoise, OfWhatScansHardlyTellIsTheNominal) {
  constexpr double kSigma_m = 0.5;
  Vector6d variance = kExact;
  variance[3] = kSigma_m * kSigma_m;
  ProcessNoise told(nominal()), believed(nominal());
  std::mt19937 rng(1);
  std::normal_distribution<double> normal;
  double told_sum = 0.0, believed_sum = 0.0;
  for (std::int64_t scan = 0; scan < 2000; ++scan) {
    const Pose T{Eigen::Quaterniond::Identity(), {kSigma_m * normal(rng), 0.0, 0.0}};
    told.observe(T, scan * kScan_ns, variance);
    believed.observe(T, scan * kScan_ns, kExact);
    told_sum += told.density()[3];
    believed_sum += believed.density()[3];
  }
  EXPECT_LT(told_sum, 0.6 * believed_sum);
}

// A scan of bare level ground may leave the information singular.
TEST(ProcessNoise, SurvivesAVarianceThatIsNoNumber) {
  ProcessNoise noise(nominal());
  const Vector6d unknown = Vector6d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (std::int64_t scan = 0; scan < 5; ++scan) noise.observe({}, scan * kScan_ns, unknown);
  EXPECT_EQ(noise.density(), nominal());
}

constexpr int kSegments = 2;
constexpr int kSize = kKnotSize * (kSegments + 1);

// A constant acceleration a over dt departs by a dt^2/2 and a dt: a^2 dt / q, over two numbers.
TEST(NormalisedInnovation, IsOneUnderThePriorInflatedByIt) {
  Prior prior;
  prior.segments = kSegments;
  prior.acceleration_density = nominal();
  const double a = 20.0, dt_s = prior.span_s / kSegments;
  Unknowns x = Unknowns::Zero(kSize);
  for (int k = 1; k <= kSegments; ++k) {
    const double t_s = k * dt_s;
    x[kKnotSize * k + 5] = 0.5 * a * t_s * t_s;
    x[kKnotSize * k + 11] = a * t_s;
  }
  const Vector6d innovation = normalised_innovation(prior, x);
  EXPECT_EQ(innovation.head<5>(), Vector6d::Zero().head<5>());
  EXPECT_NEAR(innovation[5], a * a * dt_s / 3.0 / 2.0, 1e-9);
  const Prior wide = inflated(prior, innovation);
  EXPECT_EQ(wide.acceleration_density.head<5>(), prior.acceleration_density.head<5>());
  EXPECT_NEAR(normalised_innovation(wide, x)[5], 1.0, 1e-9);
}

// Between two known knots the middle is uncertain by q dt^3 / 192: 1 mrad at 0.086 s and 0.3.
TEST(Segments, AreAsManyAsTheProcessNoiseAsksFor) {
  Vector6d density = nominal();
  EXPECT_EQ(segments_for(density, 0.08, 1), 1);
  EXPECT_EQ(segments_for(density, 0.1, 1), 2);
  EXPECT_EQ(segments_for(density, 0.1, 3), 3);
  density.head<3>().setConstant(3.0);  // 1 mrad at 0.040 s
  EXPECT_EQ(segments_for(density, 0.1, 2), 3);
  density.head<3>().setConstant(1e6);
  EXPECT_EQ(segments_for(density, 0.1, 2), motion::kMaxSegments);
}

}  // namespace
}  // namespace lilo::core
