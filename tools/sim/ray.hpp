// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/mesh.hpp"

#include <algorithm>
#include <cmath>

namespace lilo::sim {

/// A half-line with the reciprocals that box tests need.
struct Ray {
  Vec3 origin, direction;  ///< direction has unit length in world coordinates
  Vec3 inverse;

  Ray(const Vec3& from, const Vec3& along) : origin(from), direction(along) {
    for (int k = 0; k < 3; ++k) {
      // A zero component would make 0 * inf = NaN in the slab test.
      const double d = std::abs(along[k]) < 1e-12 ? 1e-12 : along[k];
      inverse[k] = 1.0 / d;
    }
  }
};

/// The nearest surface found so far. `range_m` limits the search.
struct Hit {
  double range_m;
  Vec3 normal = Vec3::Zero();  ///< unit length, either side
  Material material = Material::concrete;
  bool found = false;
};

struct Box {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(3e38F);
  Eigen::Vector3f high = Eigen::Vector3f::Constant(-3e38F);

  void grow(const Eigen::Vector3f& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void grow(const Box& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  /// Where the ray enters the box, or a value beyond `limit` when it misses it before.
  [[nodiscard]] double enter(const Ray& ray, double limit) const {
    double near = 0.0, far = limit;
    for (int k = 0; k < 3; ++k) {
      const double t0 = (static_cast<double>(low[k]) - ray.origin[k]) * ray.inverse[k];
      const double t1 = (static_cast<double>(high[k]) - ray.origin[k]) * ray.inverse[k];
      near = std::max(near, std::min(t0, t1));
      far = std::min(far, std::max(t0, t1));
    }
    return near <= far ? near : kMiss;
  }
  static constexpr double kMiss = 1e300;
};

/// Distance along the ray to the triangle a, b, c (Moeller and Trumbore 1997, in doubles: single
/// precision costs millimetres at grazing incidence), or Box::kMiss.
inline double intersect(const Ray& ray, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 e1 = b - a, e2 = c - a;
  const Vec3 p(ray.direction.y() * e2.z() - ray.direction.z() * e2.y(),
               ray.direction.z() * e2.x() - ray.direction.x() * e2.z(),
               ray.direction.x() * e2.y() - ray.direction.y() * e2.x());
  const double det = e1.x() * p.x() + e1.y() * p.y() + e1.z() * p.z();
  if (det == 0.0) return Box::kMiss;
  const double inverse = 1.0 / det;
  const Vec3 s = ray.origin - a;
  const double u = (s.x() * p.x() + s.y() * p.y() + s.z() * p.z()) * inverse;
  // Edges are a hair wider than they are: neighbours must not leave a slit between them.
  constexpr double kEdge = 1e-9;
  if (u < -kEdge || u > 1.0 + kEdge) return Box::kMiss;
  const Vec3 q(s.y() * e1.z() - s.z() * e1.y(), s.z() * e1.x() - s.x() * e1.z(),
               s.x() * e1.y() - s.y() * e1.x());
  const double v =
      (ray.direction.x() * q.x() + ray.direction.y() * q.y() + ray.direction.z() * q.z()) * inverse;
  if (v < -kEdge || u + v > 1.0 + kEdge) return Box::kMiss;
  const double t = (e2.x() * q.x() + e2.y() * q.y() + e2.z() * q.z()) * inverse;
  return t > 0.0 ? t : Box::kMiss;
}

}  // namespace lilo::sim
