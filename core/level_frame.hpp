// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/calibration/beam_estimate.hpp"
#include "core/estimate.hpp"
#include "core/scan.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <vector>

/// Between the axes of a sensor and level ones, R = ScanFeatures::R_level_sensor.
namespace lilo {

/// Whether the sensor is upside down.
[[nodiscard]] inline bool is_upside_down(const Eigen::Quaterniond& R_level_sensor) {
  return (R_level_sensor * Eigen::Vector3d::UnitZ()).z() < 0.0;
}

/// Those of an upside-down sensor in reverse order and negative, so that ring 0 is the lowest one
/// again: ring k becomes ring_count - 1 - k. Otherwise as they are.
[[nodiscard]] BeamTable in_level_axes(const BeamTable& beams,
                                      const Eigen::Quaterniond& R_level_sensor);

/// What is known of their errors, likewise: rings in reverse order, and all errors negative but the
/// sine of the eccentricity, as azimuths are counted the other way round.
[[nodiscard]] BeamEstimate in_level_axes(BeamEstimate beams,
                                         const Eigen::Quaterniond& R_level_sensor);
[[nodiscard]] BeamEstimate in_sensor_axes(const BeamEstimate& beams,
                                          const Eigen::Quaterniond& R_level_sensor);

/// Turns an estimate from level axes to the sensor's. Both odometry frames begin at the sensor, so
/// that the pose T becomes inverse(R) T R.
[[nodiscard]] Estimate in_sensor_axes(Estimate estimate, const Eigen::Quaterniond& R_level_sensor);

/// Turns points (m) in place: from the level odometry frame to the sensor's, or from the level axes
/// of a scan to the sensor's.
void turn_to_sensor_axes(const Eigen::Quaterniond& R_level_sensor,
                         std::vector<Eigen::Vector3f>& points_m);

}  // namespace lilo
