// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace lilo::sim {

using Vec3 = Eigen::Vector3d;

/// What a surface is made of decides how brightly it answers.
enum class Material : std::uint8_t {
  asphalt,
  concrete,
  grass,
  soil,
  plaster,
  brick,
  glass,
  metal,
  paint,
  bark,
  leaf,
  cloth,
  retro
};

struct Triangle {
  Eigen::Vector3f a, b, c;
  Material material = Material::concrete;
};

/// A triangle soup. Winding does not matter: both faces answer.
using Mesh = std::vector<Triangle>;

/// Rotation, uniform scale, then translation: object coordinates to world coordinates.
struct Placement {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vec3 translation_m = Vec3::Zero();
  double scale = 1.0;

  [[nodiscard]] Vec3 operator*(const Vec3& p) const {
    return rotation * (scale * p) + translation_m;
  }
};

/// Turned by `yaw_rad` about z, then put at `at`.
Placement place(const Vec3& at, double yaw_rad, double scale = 1.0);

void append(Mesh& mesh, const Mesh& part, const Placement& placement);
void add_triangle(Mesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, Material material);

/// The parallelogram `origin`, `origin + u`, `origin + u + v`, `origin + v`.
void add_quad(Mesh& mesh, const Vec3& origin, const Vec3& u, const Vec3& v, Material material);

/// Axis-aligned box between two corners.
void add_box(Mesh& mesh, const Vec3& low, const Vec3& high, Material material);

/// Frustum between two circles in planes orthogonal to the axis `from`-`to`, `sides` faces, closed
/// at `to`. Radii may differ.
void add_frustum(Mesh& mesh, const Vec3& from, const Vec3& to, double radius_from_m,
                 double radius_to_m, int sides, Material material);

/// Ellipsoid, `rings` by `2 rings` faces.
void add_ellipsoid(Mesh& mesh, const Vec3& centre, const Vec3& radii, int rings, Material material);

}  // namespace lilo::sim
