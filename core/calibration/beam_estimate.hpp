// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/scan.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lilo {

/// What is known of the errors of a sensor's beams: to be kept from one run to the next. Of a
/// levelled sensor azimuths are about the vertical and elevations are towards it
/// (core::BeamCorrection), so that the estimate holds for that tilt. The order of the rings and all
/// signs are the sensor's, also if it is upside down.
/// Trivially copyable, so that threads can share it.
struct BeamEstimate {
  int ring_count = 0;                             ///< 0: nothing is known
  std::array<double, kMaxRings> elevation_rad{};  ///< to be added to that of each ring
  std::array<double, kMaxRings> elevation_sigma_rad{};
  /// To be added to an azimuth: [0] * cos(azimuth) + [1] * sin(azimuth).
  std::array<double, 2> eccentricity_rad{};
  double eccentricity_sigma_rad = 0.0;
  /// Of a ring 5 degrees off the horizon, on the side of the ground. To be added to each ring that
  /// saw the ground, in inverse proportion to its elevation.
  double common_elevation_rad = 0.0;
  double common_elevation_sigma_rad = 0.0;
  /// What the path alone tells of it, without what the errors of the rings let expect. It is not
  /// applied by itself. Sigma 0: nothing.
  double common_by_path_rad = 0.0;
  double common_by_path_sigma_rad = 0.0;

  bool operator==(const BeamEstimate&) const = default;
};

/// The largest correction of an elevation, and of an azimuth. What the elevations have in common
/// counts as at 5 degrees.
inline double largest_elevation_rad(const BeamEstimate& beams) {
  double largest = std::abs(beams.common_elevation_rad);
  for (const double rad : beams.elevation_rad) largest = std::max(largest, std::abs(rad));
  return largest;
}
inline double largest_azimuth_rad(const BeamEstimate& beams) {
  return std::hypot(beams.eccentricity_rad[0], beams.eccentricity_rad[1]);
}

}  // namespace lilo
