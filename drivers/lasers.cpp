// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/lasers.hpp"

#include "drivers/wire.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lilo {
namespace {

float square(float v) { return v * v; }

bool needs_more_than_angles(const LaserCorrection& c) {
  return c.dist_m != 0.0 || c.two_point || c.horiz_offset_m != 0.0 || c.focal_slope != 0.0 ||
         c.min_intensity > 0 || c.max_intensity < 255;
}

void set_corrections(const LaserCorrection& c, std::size_t i, Lasers& lasers) {
  const auto f = [](double v) { return static_cast<float>(v); };
  const auto near = [&](double near_m, float near_at_m) {
    return c.two_point ? f(near_m - c.dist_m) / (kFarM - near_at_m) : 0.0F;
  };
  lasers.dist_m[i] = f(c.dist_m);
  lasers.near_x[i] = near(c.dist_x_m, kNearXM);
  lasers.near_y[i] = near(c.dist_y_m, kNearYM);
  lasers.horizontal_m[i] = f(c.horiz_offset_m);
  lasers.focal[i] = square(1.0F - f(c.focal_distance_m) / kFocalRangeM);
  lasers.slope[i] = 256.0F * f(c.focal_slope);
  lasers.min_intensity[i] = f(std::clamp(c.min_intensity, 0, 255));
  lasers.max_intensity[i] = f(std::clamp(c.max_intensity, 0, 255));
}

}  // namespace

void set_lasers(const Calibration& calibration, double step_m, double min_range_m,
                double max_range_m, Lasers& lasers) {
  const std::size_t count = std::min<std::size_t>(calibration.lasers.size(), kMaxRings);
  std::array<std::size_t, kMaxRings> by_elevation{};
  std::iota(by_elevation.begin(), by_elevation.end(), 0U);
  std::sort(by_elevation.begin(), by_elevation.begin() + static_cast<std::ptrdiff_t>(count),
            [&](std::size_t a, std::size_t b) {
              return calibration.lasers[a].vert_rad < calibration.lasers[b].vert_rad;
            });
  lasers.beams = {.ring_count = static_cast<int>(count), .elevation_rad = {}};
  lasers.step_m = static_cast<float>(step_m);
  lasers.largest_rot_rad = 0.0F;
  lasers.corrected =
      std::any_of(calibration.lasers.begin(), calibration.lasers.end(), needs_more_than_angles);
  constexpr double kMostSteps = 65535.0;
  for (std::size_t ring = 0; ring < count; ++ring) {
    const std::size_t i = by_elevation[ring];
    const LaserCorrection& c = calibration.lasers[i];
    lasers.beams.elevation_rad[ring] = static_cast<float>(c.vert_rad);
    lasers.cos_w[i] = static_cast<float>(std::cos(c.vert_rad));
    lasers.sin_w[i] = static_cast<float>(std::sin(c.vert_rad));
    lasers.vertical_m[i] = static_cast<float>(c.vert_offset_m);
    lasers.cos_rot[i] = static_cast<float>(std::cos(c.rot_rad));
    lasers.sin_rot[i] = static_cast<float>(std::sin(c.rot_rad));
    lasers.rot_rad[i] = static_cast<float>(c.rot_rad);
    lasers.largest_rot_rad = std::max(lasers.largest_rot_rad, std::abs(lasers.rot_rad[i]));
    lasers.min_steps[i] =
        std::max(1, static_cast<int>(std::ceil((min_range_m - c.dist_m) / step_m)));
    lasers.max_steps[i] =
        static_cast<int>(std::min(kMostSteps, std::floor((max_range_m - c.dist_m) / step_m)));
    lasers.ring[i] = static_cast<std::int32_t>(ring);
    set_corrections(c, i, lasers);
  }
}

void turn_lasers(const Lasers& lasers, int count, std::span<const std::int32_t> delay_ns,
                 double ticks_per_ns, LaserAngles& angles) {
  for (std::size_t i = 0; i < delay_ns.size(); ++i) {
    const auto a = static_cast<float>(ticks_per_ns * delay_ns[i] * wire::kRadPerTick);
    angles.rad[i] = a;  // at most 0.1 rad, where these series are exact to float
    angles.cos[i] = 1.0F - a * a * (0.5F - a * a / 24.0F);
    angles.sin[i] = a - a * a * a * (1.0F / 6.0F - a * a / 120.0F);
  }
  const double last_ns = delay_ns.empty() ? 0 : delay_ns.back();
  angles.largest_rad = std::abs(static_cast<float>(ticks_per_ns * last_ns * wire::kRadPerTick)) +
                       lasers.largest_rot_rad;
  if (lasers.largest_rot_rad <= 0.0F) return;
  const auto cycle = static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < delay_ns.size(); ++i) {
    const std::size_t k = i < cycle ? i : i - cycle;
    const float cos = angles.cos[i], sin = angles.sin[i];
    angles.cos[i] = cos * lasers.cos_rot[k] + sin * lasers.sin_rot[k];
    angles.sin[i] = sin * lasers.cos_rot[k] - cos * lasers.sin_rot[k];
    angles.rad[i] -= lasers.rot_rad[k];
  }
}

}  // namespace lilo
