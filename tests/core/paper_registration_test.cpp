// SPDX-License-Identifier: BSD-3-Clause
#include "core/paper/registration.hpp"

#include <gtest/gtest.h>

#include <random>

namespace lilo::paper {
namespace {

Eigen::Vector3d random_vector(std::mt19937& rng, double scale) {
  std::uniform_real_distribution<double> u(-scale, scale);
  return {u(rng), u(rng), u(rng)};
}

Pose stepped(const Pose& T, int axis, double h) {
  Pose moved = T;
  if (axis < 3) {
    moved.rotation = (so3_exp(h * Eigen::Vector3d::Unit(axis)) * T.rotation).normalized();
  } else {
    moved.translation_m += h * Eigen::Vector3d::Unit(axis - 3);
  }
  return moved;
}

TEST(Residuals, AnalyticJacobiansEqualNumericOnes) {
  constexpr double h = 1e-6;
  std::mt19937 rng(7);
  for (int k = 0; k < 50; ++k) {
    const Pose T{so3_exp(random_vector(rng, 1.0)), random_vector(rng, 50.0)};
    const Eigen::Vector3d p = random_vector(rng, 20.0);
    const Primitive primitive{random_vector(rng, 60.0), random_vector(rng, 1.0).normalized(), true};
    const LineResidual line = line_residual(T, p, primitive);
    const PlaneResidual plane = plane_residual(T, p, primitive);
    for (int axis = 0; axis < 6; ++axis) {
      const Pose ahead = stepped(T, axis, h), behind = stepped(T, axis, -h);
      const Eigen::Vector3d d_line =
          (line_residual(ahead, p, primitive).value - line_residual(behind, p, primitive).value) /
          (2.0 * h);
      const double d_plane =
          (plane_residual(ahead, p, primitive).value - plane_residual(behind, p, primitive).value) /
          (2.0 * h);
      EXPECT_NEAR((d_line - line.jacobian.col(axis)).norm(), 0.0, 1e-6);
      EXPECT_NEAR(d_plane - plane.jacobian(axis), 0.0, 1e-6);
    }
  }
}

TEST(Residuals, LineResidualIsTheDistanceOfEquation21) {
  std::mt19937 rng(8);
  const Pose T{so3_exp(random_vector(rng, 1.0)), random_vector(rng, 5.0)};
  const Eigen::Vector3d p = random_vector(rng, 5.0);
  const Primitive line{random_vector(rng, 5.0), random_vector(rng, 1.0).normalized(), true};
  const Eigen::Vector3d cross = (T * p - line.point).cross(line.axis);
  const double f_E = (cross / cross.norm()).dot(cross);  // Eqs. 21 and 22 as printed
  EXPECT_NEAR(line_residual(T, p, line).value.norm(), f_E, 1e-12);
}

TEST(Fits, FindTheLineAndThePlaneTheirPointsCameFrom) {
  std::mt19937 rng(9);
  std::normal_distribution<double> noise(0.0, 0.005);
  std::uniform_real_distribution<double> along(-1.0, 1.0);
  const Eigen::Vector3d axis = random_vector(rng, 1.0).normalized();
  const Eigen::Vector3d side = axis.unitOrthogonal();
  Cloud line, plane;
  std::vector<int> indices;
  for (int k = 0; k < 40; ++k) {
    Point on_line, on_plane;
    on_line.getVector3fMap() =
        (along(rng) * axis + Eigen::Vector3d(noise(rng), noise(rng), noise(rng))).cast<float>();
    on_plane.getVector3fMap() =
        (along(rng) * side + along(rng) * axis.cross(side) + noise(rng) * axis).cast<float>();
    line.push_back(on_line);
    plane.push_back(on_plane);
    indices.push_back(k);
  }
  const Primitive found_line = fit_line(line, indices), found_plane = fit_plane(plane, indices);
  ASSERT_TRUE(found_line.valid && found_plane.valid);
  EXPECT_GT(std::abs(found_line.axis.dot(axis)), std::cos(0.02));
  EXPECT_GT(std::abs(found_plane.axis.dot(axis)), std::cos(0.02));
  EXPECT_FALSE(fit_line(plane, indices).valid);
  EXPECT_FALSE(fit_plane(line, {0, 1, 2, 3}).valid);  // too few
}

/// Three walls at right angles, none touching another, and three straight edges, in the frame whose
/// pose in the map is `X`.
struct Corner {
  LocalMap edges{0.1, 1000.0}, surfaces{0.1, 1000.0};
  Cloud edge_features, surface_features;

  explicit Corner(const Pose& X) {
    Cloud lines, walls;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3f n = Eigen::Vector3f::Unit(axis),
                            u = Eigen::Vector3f::Unit((axis + 1) % 3),
                            v = Eigen::Vector3f::Unit((axis + 2) % 3);
      for (int a = 0; a < 24; ++a) {
        add(lines, 5.0F * (u - v) + 0.25F * static_cast<float>(a) * n);
        add(edge_features, 5.0F * (u - v) + (0.1F + 0.2F * static_cast<float>(a)) * n);
        for (int b = 0; b < 24; ++b) {
          const Eigen::Vector3f on_wall =
              7.0F * n + 0.25F * (static_cast<float>(a) * u + static_cast<float>(b) * v);
          add(walls, on_wall);
          if (a % 3 == 1 && b % 3 == 1) add(surface_features, on_wall + 0.1F * u);
        }
      }
    }
    edges.update({&lines}, X);
    surfaces.update({&walls}, X);
  }
  static void add(Cloud& cloud, const Eigen::Vector3f& at) {
    cloud.push_back({});
    cloud.back().getVector3fMap() = at;
  }
};

TEST(Alignment, MovingTheWholeProblemMovesTheAnswer) {
  std::mt19937 rng(11);
  const Pose off{so3_exp({0.01, 0.02, -0.015}), {0.1, -0.08, 0.05}};
  for (int k = 0; k < 8; ++k) {
    const Pose X{so3_exp(random_vector(rng, 2.0)), random_vector(rng, 20.0)};
    const Corner corner(X);
    std::int64_t left = 1'000'000;
    const Alignment found = align(corner.edge_features, corner.surface_features, corner.edges,
                                  corner.surfaces, X * off, 1.0, {}, left);
    EXPECT_TRUE(found.converged);
    EXPECT_GT(found.correspondences, 200);
    const Pose error = X.inverse() * found.T_odom_sensor;
    EXPECT_LT(error.translation_m.norm(), 1e-3) << k;
    EXPECT_LT(so3_log(error.rotation).norm(), 1e-4) << k;
  }
}

// However large the neighbourhood, a scan ends.
TEST(Alignment, EndsWhenItHasSeenAsManyNeighboursAsItMay) {
  constexpr double kEverything_m = 100.0;
  const Corner corner({});
  const auto points = static_cast<std::int64_t>(corner.surfaces.cloud().size());
  const Pose guess{so3_exp({0.01, 0.02, -0.015}), {0.1, -0.08, 0.05}};
  std::int64_t left = 20 * points;
  const Alignment found = align(corner.edge_features, corner.surface_features, corner.edges,
                                corner.surfaces, guess, kEverything_m, {}, left);
  EXPECT_FALSE(found.converged);
  EXPECT_EQ(found.iterations, 0);
  EXPECT_LE(left, 0);
  EXPECT_GT(left, -points) << "no more than the search under way";
  EXPECT_EQ(found.T_odom_sensor.translation_m, guess.translation_m) << "no step of half the scan";
}

}  // namespace
}  // namespace lilo::paper
