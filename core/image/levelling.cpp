// SPDX-License-Identifier: BSD-3-Clause
#include "core/image/levelling.hpp"

#include "core/constants.hpp"
#include "core/image/constants.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace lilo::core {
namespace {

using Points = std::span<const Eigen::Vector3d>;  // m, sensor's axes

struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // a unit vector, up
  double offset_m = 0.0;                              // of points: normal . point
  double share = 0.0;                                 // of all points that is in it
  double thickness_m = 0.0;                           // 1 sigma of these, along the normal
  double width_m = 0.0;  // 1 sigma of these, along the direction in which they spread less

  [[nodiscard]] bool has(const Eigen::Vector3d& point_m) const {
    return std::abs(normal.dot(point_m) - offset_m) < image::kInGround * point_m.norm();
  }
  [[nodiscard]] double tilt_rad() const { return std::acos(std::min(normal.z(), 1.0)); }
};

/// Half a turn about x.
Eigen::Quaterniond turned_over() { return {0.0, 1.0, 0.0, 0.0}; }

bool is_flat_within(float most_m, const Feature& f) {
  return f.kind == FeatureKind::ground && f.x_m * f.x_m + f.y_m * f.y_m < most_m * most_m;
}

/// None where the points are nearly in a line, or the plane is too steep for a tilted sensor.
std::optional<Plane> through(const Eigen::Vector3d& a_m, const Eigen::Vector3d& b_m,
                             const Eigen::Vector3d& c_m) {
  Eigen::Vector3d normal = (b_m - a_m).cross(c_m - a_m);
  const double area_m2 = 0.5 * normal.norm();
  if (area_m2 < image::kLeastTriangle_m2) return std::nullopt;
  normal *= (normal.z() < 0.0 ? -0.5 : 0.5) / area_m2;
  const Plane plane{normal, normal.dot(a_m)};
  if (plane.tilt_rad() > image::kMostTilt_rad) return std::nullopt;
  return plane;
}

/// Points that are in a plane: how many, and how they spread.
struct Support {
  double count = 0.0;
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
  /// From the normal to the direction in which they spread most.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Eigen::Vector3d sigma_m = Eigen::Vector3d::Zero();
};

Support support_of(const Plane& plane, Points points_m) {
  Support s;
  Eigen::Matrix3d square_m2 = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& at_m : points_m) {
    if (!plane.has(at_m)) continue;
    s.count += 1.0;
    s.mean_m += at_m;
    square_m2 += at_m * at_m.transpose();
  }
  if (s.count == 0.0) return s;
  s.mean_m /= s.count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(square_m2 / s.count -
                                                              s.mean_m * s.mean_m.transpose());
  s.axes = spread.eigenvectors();
  s.sigma_m = spread.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return s;
}

/// Of random planes that with the most points; none if all were too steep.
std::optional<Plane> best_plane(Points points_m) {
  constexpr std::size_t kCounted = 1000;
  std::uint64_t state = 1;  // the same scan gives the same plane
  const auto any = [&]() -> const Eigen::Vector3d& {
    state = state * 6364136223846793005U + 1442695040888963407U;  // Knuth's MMIX
    return points_m[(state >> 33U) % points_m.size()];
  };
  const std::size_t stride = 1 + points_m.size() / kCounted;
  std::optional<Plane> best;
  std::ptrdiff_t most = 0;
  for (int trial = 0; trial < image::kPlaneTrials; ++trial) {
    const Eigen::Vector3d &a_m = any(), &b_m = any(), &c_m = any();  // in this order
    const auto plane = through(a_m, b_m, c_m);
    if (!plane) continue;
    std::ptrdiff_t count = 0;
    for (std::size_t k = 0; k < points_m.size(); k += stride) {
      count += std::ptrdiff_t{plane->has(points_m[k])};
    }
    if (count <= most) continue;
    most = count;
    best = plane;
  }
  return best;
}

/// The plane with the most points; none where there are too few points, or all planes too steep.
std::optional<Plane> fitted_plane(Points points_m) {
  if (points_m.size() < tracking::kMinFeatures) return std::nullopt;
  std::optional<Plane> plane = best_plane(points_m);
  if (!plane) return std::nullopt;
  Support support = support_of(*plane, points_m);
  for (int k = 0; k < image::kPlaneFits; ++k) {
    const Eigen::Vector3d normal = support.axes.col(0) * (support.axes(2, 0) < 0.0 ? -1.0 : 1.0);
    plane = Plane{normal, normal.dot(support.mean_m)};
    support = support_of(*plane, points_m);
  }
  plane->share = support.count / static_cast<double>(points_m.size());
  plane->thickness_m = support.sigma_m[0];
  plane->width_m = support.sigma_m[1];
  return plane;
}

/// Whether the plane is the ground, if it is on the right side of the sensor.
bool is_ground(const Plane& plane) {
  const bool is_strip = plane.thickness_m > image::kMostThickness * plane.width_m;
  return plane.share > 0.5 && !is_strip;
}

/// Turns the normal of the plane to z.
Eigen::Quaterniond levelled(const Plane& plane) {
  if (plane.tilt_rad() < image::kLeastTilt_rad || plane.tilt_rad() > image::kMostTilt_rad) {
    return Eigen::Quaterniond::Identity();
  }
  return Eigen::Quaterniond::FromTwoVectors(plane.normal, Eigen::Vector3d::UnitZ());
}

}  // namespace

Eigen::Quaterniond Levelling::R_level_sensor(const std::vector<Feature>& features) {
  const double count = take(features, Side::above, image::kNearGround_m);
  const std::optional<Plane> above = fitted_plane(points_m_);
  if (above && is_ground(*above) && above->width_m > image::kWidestCeiling_m &&
      above->share * count > image::kMostCeiling * count_floor(features)) {
    return levelled(*above) * turned_over();
  }
  take(features, Side::below, image::kNearGround_m);
  const std::optional<Plane> below = fitted_plane(points_m_);
  return below && is_ground(*below) ? levelled(*below) : Eigen::Quaterniond::Identity();
}

/// Twice as far as the ground that tells the tilt: to a sensor that is 4 m high, of 16 beams the
/// nearest meets the floor at 15 m. Without a limit, canopies passed for a floor.
double Levelling::count_floor(const std::vector<Feature>& features) {
  const double count = take(features, Side::below, 2.0F * image::kNearGround_m);
  const std::optional<Plane> below = fitted_plane(points_m_);
  // A plane that passes above the sensor is a far part of the ground overhead, which a tilted
  // sensor sees below its horizon.
  const bool is_floor = below && below->offset_m < 0.0;
  // So that a canopy overhead of fewer than kMostCeiling * kMinFeatures is no ground.
  constexpr auto kLeast = static_cast<double>(tracking::kMinFeatures);
  return is_floor ? std::max(below->share * count, kLeast) : kLeast;
}

double Levelling::take(const std::vector<Feature>& features, Side side, float most_m) {
  const auto is_wanted = [&](const Feature& f) {
    return is_flat_within(most_m, f) && is_overhead(f) == (side == Side::above);
  };
  const auto count =
      static_cast<std::size_t>(std::count_if(features.begin(), features.end(), is_wanted));
  const std::size_t stride = 1 + count / kMostPoints;
  const Eigen::Matrix3d turn = side == Side::above ? turned_over().toRotationMatrix()
                                                   : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  points_m_.clear();
  std::size_t n = 0;
  for (const Feature& f : features) {
    if (!is_wanted(f) || n++ % stride != 0) continue;
    points_m_.push_back(turn * Eigen::Vector3f(f.x_m, f.y_m, f.z_m).cast<double>());
  }
  return static_cast<double>(count);
}

}  // namespace lilo::core
