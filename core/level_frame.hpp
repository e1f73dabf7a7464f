// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/estimate.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <vector>

/// Results for a levelled sensor, turned to the sensor's own axes.
namespace lilo {

/// Turns an estimate from the axes of the features (R = ScanFeatures::R_level_sensor) to the
/// sensor's. Both odometry frames begin at the sensor, so that the pose T becomes inverse(R) T R.
[[nodiscard]] Estimate in_sensor_axes(Estimate estimate, const Eigen::Quaterniond& R_level_sensor);

/// Turns points (m) in place: from the level odometry frame to the sensor's, or from the level axes
/// of a scan to the sensor's.
void turn_to_sensor_axes(const Eigen::Quaterniond& R_level_sensor,
                         std::vector<Eigen::Vector3f>& points_m);

}  // namespace lilo
