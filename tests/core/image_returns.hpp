// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/feature.hpp"
#include "core/scan.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace lilo::test {

/// The middle of a column of an image so many wide.
inline double azimuth_of(int column, int columns) {
  return std::numbers::pi * (1.0 - 2.0 * (column + 0.5) / columns);
}

/// Where a ring meets what stands so far away.
inline Return return_at(const BeamTable& beams, std::uint8_t ring, double azimuth_rad,
                        double flat_m) {
  const double up = std::tan(static_cast<double>(beams.elevation_rad[ring]));
  return {.x_m = static_cast<float>(flat_m * std::cos(azimuth_rad)),
          .y_m = static_cast<float>(flat_m * std::sin(azimuth_rad)),
          .z_m = static_cast<float>(flat_m * up),
          .azimuth_rad = static_cast<float>(azimuth_rad),
          .ring = ring};
}

/// From a feature to the next sample of its surface.
inline Eigen::Vector3d gap_of(const Feature& f) {
  return Eigen::Vector3f(f.dx_m, f.dy_m, f.dz_m).cast<double>();
}

}  // namespace lilo::test
