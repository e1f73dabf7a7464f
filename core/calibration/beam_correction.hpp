// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/feature.hpp"
#include "core/scan.hpp"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <vector>

/// Errors of a sensor's beams that its calibration does not have.
namespace lilo::core {

/// Corrections to be added to elevations and azimuths. An encoder whose disc is mounted off the
/// axis reports azimuths with an error of one period a revolution. Its correction is cosine *
/// cos(azimuth) + sine * sin(azimuth), with azimuths counter-clockwise from +x.
struct BeamCorrection {
  std::array<double, kMaxRings> elevation_rad{};               ///< by ring
  Eigen::Vector2d eccentricity_rad = Eigen::Vector2d::Zero();  ///< cosine and sine

  void apply(std::vector<Feature>& features) const;
};

/// How a point moves, in the sensor's frame, per radian of its beam's elevation.
inline Eigen::Vector3f moved_by_elevation(const Feature& f) {
  const float horizontal_m = std::sqrt(f.x_m * f.x_m + f.y_m * f.y_m);
  const float slope = horizontal_m > 0.0F ? -f.z_m / horizontal_m : 0.0F;
  return {slope * f.x_m, slope * f.y_m, horizontal_m};
}

/// The same by eccentricity: a column for the cosine and one for the sine.
using MovedByEccentricity = Eigen::Matrix<float, 3, 2>;
inline MovedByEccentricity moved_by_eccentricity(const Feature& f) {
  const float horizontal_m = std::sqrt(f.x_m * f.x_m + f.y_m * f.y_m);
  const float per_m = horizontal_m > 0.0F ? 1.0F / horizontal_m : 0.0F;
  const Eigen::Vector3f by_azimuth(-f.y_m, f.x_m, 0.0F);
  MovedByEccentricity moved;
  moved << f.x_m * per_m * by_azimuth, f.y_m * per_m * by_azimuth;
  return moved;
}

}  // namespace lilo::core
