// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/weak_directions.hpp"

#include "core/odometry.hpp"
#include "core/pose.hpp"
#include "tests/core/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace lilo {
namespace {

const BeamTable k16 = test::even_beams(16, -15.0, 15.0);

/// A VLP-16's. Without any, and with the very same firings every turn, a wall is sampled at the
/// same places again and again: 60 m ahead, where rings are metres apart, they look like posts.
constexpr float kRangeNoise_m = 0.012F;

/// Drives straight along x and returns the last estimate.
Estimate drive_through(const test::Scene& scene) {
  Odometry odometry{OdometryConfig{}};
  std::mt19937 rng(1);
  Estimate last;
  for (int k = 0; k < 20; ++k) {
    Scan scan = test::scan_of(
        scene, k16, 900,
        [&](double s) {
          return Pose{Eigen::Quaterniond::Identity(), {0.05 * (k + s), 0.0, 0.0}};
        },
        static_cast<std::uint64_t>(k));
    test::add_range_noise(scan, kRangeNoise_m, rng);
    last = odometry.process(scan);
  }
  return last;
}

TEST(WeakDirections, IsTheOneThatTheScanLeavesToThePrediction) {
  Vector6d scan, prediction;
  scan << 900, 900, 900, 300, 25, 900;  // rx ry rz x y z
  prediction << 100, 100, 100, 100, 100, 100;
  const Eigen::Quaterniond quarter_turn(
      Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()));
  const auto weak = core::weak_directions(scan.asDiagonal(), prediction.asDiagonal(), quarter_turn);
  ASSERT_EQ(weak.count, 1);
  EXPECT_NEAR(weak.all[0].from_scan, 0.2, 1e-9);  // 25 of 125
  // y of the odometry's frame is x of a sensor that is turned left by a quarter.
  EXPECT_NEAR(std::abs(weak.all[0].direction[0]), 1.0, 1e-9);
}

TEST(WeakDirections, NoneWhereTheScanKnowsMore) {
  const Matrix6d one = Matrix6d::Identity();
  EXPECT_EQ(core::weak_directions(1.1 * one, one, Eigen::Quaterniond::Identity()).count, 0);
}

TEST(WeakDirections, AScanThatSaysNothingIsWeakEverywhere) {
  const auto weak =
      core::weak_directions(Matrix6d::Zero(), Matrix6d::Identity(), Eigen::Quaterniond::Identity());
  ASSERT_EQ(weak.count, 6);
  for (const WeakDirection& one : weak.all) EXPECT_EQ(one.from_scan, 0.0);
}

/// A bend of `turn_radpm`. The scan has `share` of the motion's information along it,
/// `share_across` across it and `share_of_pitch` of pitch. The columns of `basis` are
/// orthogonal with respect to either information, but neither is a multiple of the identity.
struct Bend {
  explicit Bend(double turn_radpm, double share = 0.1, double share_across = 100.0,
                double share_of_pitch = 100.0) {
    basis << 0.9, 0.1, 0.0, 0.0, 0.0, 0.0,  // rows: rx ry rz x y z
        0.0, 1.1, 0.3, 0.0, 0.1, 0.0,       //
        0.2, 0.0, 0.8, 0.0, 0.0, 0.3,       //
        0.0, 0.0, 0.1, 0.0, 0.0, 0.0,       //
        0.1, 0.0, 0.0, 0.0, 0.9, 0.2,       //
        0.0, 0.2, 0.0, 0.0, 0.0, 1.0;
    basis.col(3) << 0.0, 0.0, turn_radpm, 1.0, 0.0, 0.0;
    Vector6d shares = Vector6d::Constant(100.0);
    shares[3] = share;
    shares[4] = share_across;
    shares[1] = share_of_pitch;
    const Matrix6d back = basis.inverse();
    motion = back.transpose() * back;
    scan = back.transpose() * shares.asDiagonal() * back;
  }
  [[nodiscard]] Vector6d along() const { return basis.col(3); }
  /// The gradient that hold() makes of kGradient.
  [[nodiscard]] Vector6d held() const {
    Vector6d gradient = kGradient;
    core::DeadReckoning(scan, motion).hold(kDeviation, scan, gradient);
    return gradient;
  }

  static inline const Vector6d kDeviation{{0.01, 0.02, 0.03, 0.4, -0.05, 0.06}};
  static inline const Vector6d kGradient{{5.0, -4.0, 3.0, -200.0, 7.0, 8.0}};
  Matrix6d basis, scan, motion;
};

TEST(DeadReckoning, OnlyThePredictionMovesThePoseAlong) {
  const Bend bend(0.2);
  const Vector6d held = bend.held();
  // Along the bend as though the scan had been measured where it was predicted; along the others as
  // it was.
  for (int k = 0; k < 6; ++k) {
    const Vector6d motion = bend.basis.col(k);
    const double expected =
        k == 3 ? -motion.dot(bend.scan * Bend::kDeviation) : motion.dot(Bend::kGradient);
    EXPECT_NEAR(motion.dot(held), expected, 1e-9) << k;
  }
  EXPECT_GT((held - Bend::kGradient).norm(), 100.0);
}

// The residuals of a part of the scan have other weak directions.
TEST(DeadReckoning, APartOfTheScanIsHeldByItsOwnInformation) {
  const Bend bend(0.2);
  const Matrix6d part = Vector6d{{4.0, 3.0, 2.0, 0.5, 6.0, 1.0}}.asDiagonal();
  Vector6d gradient = Bend::kGradient;
  core::DeadReckoning(bend.scan, bend.motion).hold(Bend::kDeviation, part, gradient);
  const double deviation = bend.along().dot(bend.motion * Bend::kDeviation);
  EXPECT_NEAR(bend.along().dot(gradient), -bend.along().dot(part * bend.along()) * deviation, 1e-9);
}

TEST(DeadReckoning, NoneWhereTheScanTellsMore) {
  EXPECT_EQ(Bend(0.2, 0.3).held(), Bend::kGradient);
}

// What mostly turns the sensor, the scan is asked all the same.
TEST(DeadReckoning, NoneThatMostlyTurns) { EXPECT_EQ(Bend(5.0).held(), Bend::kGradient); }

/// Whether it holds what the scan tells along x, where the scan has so much information along the
/// three axes and the motion model has 100 along each.
bool holds_x(double along, double across, double up) {
  Vector6d scan, motion;
  scan << 1e6, 1e6, 1e6, along, across, up;  // rx ry rz x y z
  motion << 1e3, 1e3, 1e3, 100.0, 100.0, 100.0;
  Vector6d gradient = Bend::kGradient;
  core::DeadReckoning(scan.asDiagonal(), motion.asDiagonal())
      .hold(Bend::kDeviation, scan.asDiagonal(), gradient);
  const bool is_held = gradient[3] != Bend::kGradient[3];
  gradient[3] = Bend::kGradient[3];
  EXPECT_EQ(gradient, Bend::kGradient) << "nothing else is held";
  return is_held;
}

// On bare ground a scan has little across the way as well. What it has must correct a wrong
// velocity.
TEST(DeadReckoning, NoneWhereTheScanTellsLittleAcrossAsWell) {
  EXPECT_TRUE(holds_x(10.0, 1100.0, 1e4)) << "a tunnel";
  EXPECT_FALSE(holds_x(10.0, 900.0, 1e4));
  EXPECT_FALSE(holds_x(10.0, 30.0, 1e4)) << "bare ground";
  EXPECT_FALSE(holds_x(10.0, 12.0, 1e4)) << "dense dust: two directions are dead reckoned";
  EXPECT_FALSE(holds_x(10.0, 1e4, 900.0)) << "little of the floor is seen";
}

TEST(DeadReckoning, NoneThatRises) {
  EXPECT_FALSE(holds_x(1e4, 1e4, 10.0)) << "a room of which little of the floor is seen";
}

TEST(DeadReckoning, AlsoBesideAWeakRotation) {
  EXPECT_NE(Bend(0.2, 0.1, 100.0, 0.01).held(), Bend::kGradient);
}

/// Information of a translation along a direction that is none of the axes, and along two others.
Matrix6d of_translation(double along, double across, double up) {
  const Eigen::Matrix3d R(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()));
  Matrix6d information = Matrix6d::Identity();
  information.bottomRightCorner<3, 3>() =
      R * Eigen::Vector3d(along, across, up).asDiagonal() * R.transpose();
  return information;
}

TEST(DegenerateDirection, IsTheOneAlongWhichLeastIsTold) {
  const auto found = core::degenerate_direction(of_translation(1.0, 105.0, 1000.0));
  ASSERT_TRUE(found);
  const Eigen::Matrix3d R(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()));
  EXPECT_NEAR(std::abs(found->dot(R.col(0))), 1.0, 1e-9);
  EXPECT_FALSE(core::degenerate_direction(of_translation(1.0, 95.0, 1000.0)));
  EXPECT_FALSE(core::degenerate_direction(of_translation(1.0, 2.0, 1000.0))) << "a bare field";
  EXPECT_FALSE(core::degenerate_direction(Matrix6d::Zero()));
}

TEST(DegenerateDirection, IsNoneThatRises) {
  const auto rising_by = [](double angle_rad) {
    const Eigen::Matrix3d R(Eigen::AngleAxisd(-angle_rad, Eigen::Vector3d::UnitY()));
    Matrix6d information = Matrix6d::Identity();
    information.bottomRightCorner<3, 3>() =
        R * Eigen::Vector3d(1.0, 1000.0, 2000.0).asDiagonal() * R.transpose();
    return core::degenerate_direction(information);
  };
  constexpr double kDegree_rad = std::numbers::pi / 180.0;
  EXPECT_TRUE(rising_by(44.0 * kDegree_rad)) << "a steep tunnel";
  EXPECT_FALSE(rising_by(46.0 * kDegree_rad));
  EXPECT_FALSE(rising_by(90.0 * kDegree_rad)) << "a room of which little of the floor is seen";
  Matrix6d corridor = Matrix6d::Identity();
  corridor.bottomRightCorner<3, 3>().diagonal() << 150.0, 1e5, 1.0;
  const auto along = core::degenerate_direction(corridor);
  ASSERT_TRUE(along);
  EXPECT_NEAR(std::abs(along->x()), 1.0, 1e-9) << "of its floor, too, little is seen";
}

TEST(WeakDirections, AlongATunnel) {
  const Estimate e = drive_through(test::tunnel());
  ASSERT_EQ(e.weak_count, 1);
  EXPECT_GT(std::abs(e.weak_directions[0].direction[0]), 0.99);
  EXPECT_EQ(e.status, TrackingStatus::degraded);
}

TEST(WeakDirections, NoneInAYard) {
  const Estimate e = drive_through(test::yard());
  EXPECT_EQ(e.weak_count, 0);
  EXPECT_EQ(e.status, TrackingStatus::tracking);
}

}  // namespace
}  // namespace lilo
