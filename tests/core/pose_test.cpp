// SPDX-License-Identifier: BSD-3-Clause
#include "core/pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace lilo {
namespace {

Eigen::Vector3d random_vector(std::mt19937& rng, double scale) {
  std::uniform_real_distribution<double> u(-scale, scale);
  return {u(rng), u(rng), u(rng)};
}

TEST(So3, LogInvertsExpBelowPi) {
  std::mt19937 rng(1);
  for (int k = 0; k < 1000; ++k) {
    Eigen::Vector3d w = random_vector(rng, 1.0);
    w *= std::pow(10.0, -8.0 * (k % 10) / 9.0) * 3.1 / std::sqrt(3.0);
    EXPECT_NEAR((so3_log(so3_exp(w)) - w).norm(), 0.0, 1e-12 + 1e-12 * w.norm());
  }
}

TEST(So3, ExpOfZAxisIsPlaneRotation) {
  const Eigen::Quaterniond q = so3_exp({0.0, 0.0, std::numbers::pi / 2});
  EXPECT_NEAR((q * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 0.0, 1e-15);
}

TEST(So3, ExpIsTheTurnByThatAngle) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, -2.0, 0.5).normalized();
  for (const double angle : {1e-9, 1e-3, 0.03, 0.0999, 0.1001, 1.0, 3.0}) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, axis));
    EXPECT_LT((so3_exp(angle * axis).coeffs() - turn.coeffs()).norm(), 4e-16) << angle;
  }
}

TEST(So3, SkewIsCrossProduct) {
  std::mt19937 rng(2);
  const Eigen::Vector3d a = random_vector(rng, 3.0), b = random_vector(rng, 3.0);
  EXPECT_NEAR((skew(a) * b - a.cross(b)).norm(), 0.0, 1e-14);
}

TEST(Pose, InverseUndoes) {
  std::mt19937 rng(3);
  const Pose T{so3_exp(random_vector(rng, 1.5)), random_vector(rng, 100.0)};
  const Pose I = T * T.inverse();
  EXPECT_NEAR(I.translation_m.norm(), 0.0, 1e-12);
  EXPECT_NEAR(so3_log(I.rotation).norm(), 0.0, 1e-14);
}

TEST(Pose, InterpolationMeetsBothEnds) {
  std::mt19937 rng(4);
  const Pose a{so3_exp(random_vector(rng, 1.0)), random_vector(rng, 10.0)};
  const Pose b{so3_exp(random_vector(rng, 1.0)), random_vector(rng, 10.0)};
  for (const double s : {0.0, 1.0}) {
    const Pose error = interpolate(a, b, s).inverse() * (s == 0.0 ? a : b);
    EXPECT_NEAR(error.translation_m.norm() + so3_log(error.rotation).norm(), 0.0, 1e-12);
  }
}

TEST(Pose, LongChainsStayRotations) {
  const Pose step{so3_exp({0.01, -0.02, 0.03}), {1.0, 0.0, 0.0}};
  Pose T;
  for (int k = 0; k < 100000; ++k) T = T * step;
  EXPECT_NEAR(T.rotation.norm(), 1.0, 1e-12);
}

}  // namespace
}  // namespace lilo
