// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/calibration/sensitivity.hpp"
#include "core/constants.hpp"
#include "core/feature.hpp"
#include "core/scan.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

/// Errors of a sensor's beams that its calibration does not have.
namespace lilo::core {

/// Corrections to be added to elevations and azimuths. An encoder whose disc is mounted off the
/// axis reports azimuths with an error of one period a revolution. Its correction is cosine *
/// cos(azimuth) + sine * sin(azimuth), with azimuths counter-clockwise from +x.
///
/// Features are in level axes (ScanFeatures::R_level_sensor). So azimuths of a tilted sensor are
/// corrected about the vertical, and elevations towards it, instead of its own axis. With its own
/// axis, the mean t of 16 drives with wrong beams and tilts of 10 to 20 degrees was 0.98 +- 0.03
/// times as large.
struct BeamCorrection {
  std::array<double, kMaxRings> elevation_rad{};               ///< by ring
  Eigen::Vector2d eccentricity_rad = Eigen::Vector2d::Zero();  ///< cosine and sine
  /// What all rings that see the ground have in common; a ring has `common_part` times that.
  double common_elevation_rad = 0.0;
  std::array<float, kMaxRings> common_part{};

  void apply(std::vector<Feature>& features) const;
};

/// The common error is in inverse proportion to the elevation below the horizon: a ring has this
/// part of that of a ring 5 degrees below. Level ground at the range r is then off by a height in
/// proportion to r^2: a paraboloid. Ground alone does not show this, because on a path that bends
/// up or down all scans agree.
inline double common_part_of(double elevation_rad) {
  // A level sensor sees no ground with such a ring. That of a tilted one is not corrected.
  if (elevation_rad >= 0.0) return 0.0;
  return calibration::kCommonAt_rad / std::max(-elevation_rad, calibration::kNearHorizon_rad);
}

/// How a point moves, in the axes of the features, per radian of its beam's elevation.
inline Eigen::Vector3f moved_by_elevation(const Feature& f) {
  const float horizontal_m = std::sqrt(f.x_m * f.x_m + f.y_m * f.y_m);
  const float slope = horizontal_m > 0.0F ? -f.z_m / horizontal_m : 0.0F;
  return {slope * f.x_m, slope * f.y_m, horizontal_m};
}

/// The same by all errors, and by the correction.
inline Sensitivity moved_by_beams(const Feature& f, const BeamCorrection& correction) {
  const float horizontal_m = std::sqrt(f.x_m * f.x_m + f.y_m * f.y_m);
  const float per_m = horizontal_m > 0.0F ? 1.0F / horizontal_m : 0.0F;
  // By an azimuth a point moves along (-y, x, 0), by an elevation as in moved_by_elevation().
  const float cosine = f.x_m * per_m, sine = f.y_m * per_m, part = correction.common_part[f.ring];
  const auto around_rad = static_cast<float>(correction.eccentricity_rad[0]) * cosine +
                          static_cast<float>(correction.eccentricity_rad[1]) * sine;
  const float up_rad = part * static_cast<float>(correction.common_elevation_rad);
  const Eigen::RowVector4f around(cosine, sine, 0.0F, around_rad), up(0.0F, 0.0F, part, up_rad);
  Sensitivity moved;
  moved.row(0) = -f.y_m * around - f.z_m * cosine * up;
  moved.row(1) = f.x_m * around - f.z_m * sine * up;
  moved.row(2) = horizontal_m * up;
  return moved;
}

/// How the points of a scan depend on the errors: each by itself, and with the pose.
struct ScanSensitivity {
  PoseSensitivity pose;
  BeamCorrection correction;  ///< with which the scan was measured
};

}  // namespace lilo::core
