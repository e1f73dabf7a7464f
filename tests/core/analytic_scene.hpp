// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/pose.hpp"
#include "core/scan.hpp"

#include <Eigen/Core>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

/// Scenes whose every range has a closed form, for tests that need the truth.
namespace lilo::test {

/// Half-space n . p = d seen from the side the normal points to.
struct Plane {
  Eigen::Vector3d normal;
  double offset_m;
};

/// Upright cylinder from the ground up.
struct Pole {
  double x_m, y_m, radius_m, top_m;
};

struct Scene {
  std::vector<Plane> planes;
  std::vector<Pole> poles;
  double max_range_m = 100.0;

  /// Distance along a unit ray, or 0 when nothing is hit.
  [[nodiscard]] double cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) const {
    double best = std::numeric_limits<double>::infinity();
    for (const Plane& plane : planes) {
      const double rate = plane.normal.dot(ray);
      const double range = (plane.offset_m - plane.normal.dot(origin)) / rate;
      if (rate < 0.0 && range > 0.0) best = std::min(best, range);
    }
    for (const Pole& pole : poles) {
      const double ox = origin.x() - pole.x_m, oy = origin.y() - pole.y_m;
      const double a = ray.x() * ray.x() + ray.y() * ray.y();
      const double b = ox * ray.x() + oy * ray.y();
      const double c = ox * ox + oy * oy - pole.radius_m * pole.radius_m;
      const double discriminant = b * b - a * c;
      if (discriminant < 0.0 || a < 1e-12) continue;
      const double range = (-b - std::sqrt(discriminant)) / a;
      if (range > 0.0 && origin.z() + range * ray.z() < pole.top_m) best = std::min(best, range);
    }
    return best <= max_range_m ? best : 0.0;
  }
};

/// Endless, 6 m wide, along x.
inline Scene tunnel() {
  Scene scene;
  scene.planes = {{{0.0, 0.0, 1.0}, -1.5}, {{0.0, -1.0, 0.0}, -3.0}, {{0.0, 1.0, 0.0}, -3.0}};
  return scene;
}

/// Flat ground at z = -height, walls of a rectangular yard, four poles.
inline Scene yard(double height_m = 1.5) {
  Scene scene;
  scene.planes = {{{0.0, 0.0, 1.0}, -height_m},
                  {{-1.0, 0.0, 0.0}, -20.0},
                  {{1.0, 0.0, 0.0}, -15.0},
                  {{0.0, -1.0, 0.0}, -12.0},
                  {{0.0, 1.0, 0.0}, -9.0}};
  scene.poles = {
      {6.0, 4.0, 0.2, 3.0}, {8.0, -5.0, 0.2, 3.0}, {-7.0, 3.0, 0.2, 3.0}, {-5.0, -6.0, 0.2, 3.0}};
  return scene;
}

/// A road along x, its ground at z = -1.8 m, with posts on both sides at uneven distances.
inline Scene road_with_posts() {
  Scene road;
  road.planes = {{{0.0, 0.0, 1.0}, -1.8}};
  for (int k = 0; k < 24; ++k) {
    const double along_m = -100.0 + 11.0 * k + 3.0 * std::sin(2.0 * k);
    road.poles.push_back({along_m, k % 2 == 0 ? 9.0 : -7.0, 0.25, 3.0});
  }
  return road;
}

inline BeamTable even_beams(int rings, double lowest_deg, double highest_deg) {
  BeamTable beams;
  beams.ring_count = rings;
  for (int k = 0; k < rings; ++k) {
    const double deg = lowest_deg + (highest_deg - lowest_deg) * k / (rings - 1);
    beams.elevation_rad[static_cast<std::size_t>(k)] =
        static_cast<float>(deg * std::numbers::pi / 180.0);
  }
  return beams;
}

/// A tenth of a second of scanning, clockwise from +x, while the sensor moves along
/// `T_world_sensor(s)`, s from 0 at the first firing to 1 at the last.
inline Scan scan_of(const Scene& scene, const BeamTable& beams, int firings,
                    const std::function<Pose(double)>& T_world_sensor, std::uint64_t index = 0) {
  constexpr double kPi = std::numbers::pi;
  Scan scan;
  scan.index = index;
  scan.start_ns = 1'000'000'000 + static_cast<std::int64_t>(index) * 100'000'000;
  scan.end_ns = scan.start_ns + 100'000'000;
  scan.complete = true;
  scan.beams = beams;
  for (int f = 0; f < firings; ++f) {
    const double s = static_cast<double>(f) / (firings - 1);
    const Pose T = T_world_sensor(s);
    double azimuth = -2.0 * kPi * f / firings;
    if (azimuth < -kPi) azimuth += 2.0 * kPi;
    for (int ring = 0; ring < beams.ring_count; ++ring) {
      const double w = static_cast<double>(beams.elevation_rad[static_cast<std::size_t>(ring)]);
      const Eigen::Vector3d ray(std::cos(w) * std::cos(azimuth), std::cos(w) * std::sin(azimuth),
                                std::sin(w));
      const double range = scene.cast(T.translation_m, T.rotation * ray);
      if (range <= 0.0) continue;
      const Eigen::Vector3f p = (range * ray).cast<float>();
      scan.returns.push_back({.x_m = p.x(),
                              .y_m = p.y(),
                              .z_m = p.z(),
                              .azimuth_rad = static_cast<float>(azimuth),
                              .t_ns = static_cast<std::int32_t>(s * 1e8),
                              .ring = static_cast<std::uint8_t>(ring),
                              .intensity = 100,
                              .kind = ReturnKind::strongest});
    }
  }
  return scan;
}

/// A range finder's noise, along each ray.
inline void add_range_noise(Scan& scan, float sigma_m, std::mt19937& rng) {
  std::normal_distribution<float> noise_m(0.0F, sigma_m);
  for (Return& r : scan.returns) {
    const float stretch = 1.0F + noise_m(rng) / std::hypot(r.x_m, r.y_m, r.z_m);
    r.x_m *= stretch;
    r.y_m *= stretch;
    r.z_m *= stretch;
  }
}

inline Scan still_scan_of(const Scene& scene, const BeamTable& beams, const Pose& T) {
  return scan_of(scene, beams, 1800, [&](double) { return T; });
}

}  // namespace lilo::test
