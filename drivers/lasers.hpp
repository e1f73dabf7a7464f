// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/scan.hpp"
#include "drivers/calibration.hpp"
#include "drivers/firing.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lilo {

/// What returns need of their lasers' corrections: an array each, so that the compiler takes
/// several lasers at a time.
struct alignas(kLineBytes) Lasers {
  using Floats = std::array<float, kMaxRings>;
  using Ints = std::array<std::int32_t, kMaxRings>;
  Floats cos_w, sin_w, vertical_m;
  Floats cos_rot, sin_rot, rot_rad;
  Ints min_steps, max_steps;  ///< range limits in distance steps
  Ints ring;
  Floats dist_m, near_x, near_y, horizontal_m;  ///< these eight: only where `corrected`
  Floats focal, slope, min_intensity, max_intensity;
  bool corrected = false;  ///< those eight differ from nothing (HDL-64E)
  float step_m = 0.002F;
  float largest_rot_rad = 0.0F;
  BeamTable beams;
};

/// `step_m`: of a distance on the wire. Returns outside of the range limits are left out.
void set_lasers(const Calibration& calibration, double step_m, double min_range_m,
                double max_range_m, Lasers& lasers);

/// The angle of each laser clockwise of its block's azimuth, at its firing: what the head has
/// turned since, less the rotational correction. Where a block holds two cycles, for each of them.
struct alignas(kLineBytes) LaserAngles {
  std::array<float, kMaxRings> cos, sin, rad;
  float largest_rad = 0.0F;
};

/// The angles when the head turns by `ticks_per_ns`. `delay_ns`: of each angle, after the
/// block's first firing; `count` lasers, one cycle or two.
void turn_lasers(const Lasers& lasers, int count, std::span<const std::int32_t> delay_ns,
                 double ticks_per_ns, LaserAngles& angles);

/// Where near-range corrections were found (manual, dual two point calibration).
inline constexpr float kFarM = 25.04F, kNearXM = 2.40F, kNearYM = 1.93F;
/// The intensity of a laser is weakest where it is out of focus: raw + slope * 256 * |(1 - f/R)^2 -
/// (1 - d/R)^2|, R the largest distance a packet can hold (S3 manual, appendix F, "Intensity
/// Compensation vs Distance").
inline constexpr float kFocalRangeM = 131.07F;

}  // namespace lilo
