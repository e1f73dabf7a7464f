// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/mesh.hpp"

#include "tools/sim/random.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace lilo::sim {

Placement place(const Vec3& at, double yaw_rad, double scale) {
  const SinCos yaw = sin_cos(yaw_rad);
  Placement placement;
  placement.rotation << yaw.cos, -yaw.sin, 0.0, yaw.sin, yaw.cos, 0.0, 0.0, 0.0, 1.0;
  placement.translation_m = at;
  placement.scale = scale;
  return placement;
}

void append(Mesh& mesh, const Mesh& part, const Placement& placement) {
  for (const Triangle& t : part) {
    add_triangle(mesh, placement * t.a.cast<double>(), placement * t.b.cast<double>(),
                 placement * t.c.cast<double>(), t.material);
  }
}

void add_triangle(Mesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, Material material) {
  mesh.push_back({a.cast<float>(), b.cast<float>(), c.cast<float>(), material});
}

void add_quad(Mesh& mesh, const Vec3& origin, const Vec3& u, const Vec3& v, Material material) {
  add_triangle(mesh, origin, origin + u, origin + u + v, material);
  add_triangle(mesh, origin, origin + u + v, origin + v, material);
}

void add_box(Mesh& mesh, const Vec3& low, const Vec3& high, Material material) {
  const Vec3 d = high - low;
  const Vec3 x(d.x(), 0.0, 0.0), y(0.0, d.y(), 0.0), z(0.0, 0.0, d.z());
  add_quad(mesh, low, x, y, material);
  add_quad(mesh, low, x, z, material);
  add_quad(mesh, low, y, z, material);
  add_quad(mesh, low + z, x, y, material);
  add_quad(mesh, low + y, x, z, material);
  add_quad(mesh, low + x, y, z, material);
}

void add_frustum(Mesh& mesh, const Vec3& from, const Vec3& to, double radius_from_m,
                 double radius_to_m, int sides, Material material) {
  const Vec3 axis = (to - from).normalized();
  const Vec3 helper = std::abs(axis.z()) < 0.9 ? Vec3(0.0, 0.0, 1.0) : Vec3(1.0, 0.0, 0.0);
  const Vec3 u = axis.cross(helper).normalized();
  const Vec3 v = axis.cross(u);
  const auto ring = [&](int k) -> Vec3 {
    const SinCos a = sin_cos(2.0 * std::numbers::pi * k / sides);
    return a.cos * u + a.sin * v;
  };
  for (int k = 0; k < sides; ++k) {
    const Vec3 e0 = ring(k), e1 = ring(k + 1);
    add_triangle(mesh, from + radius_from_m * e0, from + radius_from_m * e1, to + radius_to_m * e1,
                 material);
    add_triangle(mesh, from + radius_from_m * e0, to + radius_to_m * e1, to + radius_to_m * e0,
                 material);
    add_triangle(mesh, to, to + radius_to_m * e0, to + radius_to_m * e1, material);
  }
}

void add_ellipsoid(Mesh& mesh, const Vec3& centre, const Vec3& radii, int rings,
                   Material material) {
  const auto point = [&](int i, int j) -> Vec3 {
    const SinCos polar = sin_cos(std::numbers::pi * i / rings);
    const SinCos around = sin_cos(std::numbers::pi * j / rings);
    return centre + Vec3(radii.x() * polar.sin * around.cos, radii.y() * polar.sin * around.sin,
                         radii.z() * polar.cos);
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < 2 * rings; ++j) {
      if (i > 0) add_triangle(mesh, point(i, j), point(i, j + 1), point(i + 1, j + 1), material);
      if (i + 1 < rings) {
        add_triangle(mesh, point(i, j), point(i + 1, j + 1), point(i + 1, j), material);
      }
    }
  }
}

}  // namespace lilo::sim
