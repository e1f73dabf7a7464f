// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/config.hpp"
#include "core/estimate.hpp"

namespace lilo {

Pose to_pose(const MountConfig& mount);
bool is_identity(const MountConfig& mount);

/// The estimate of the robot's base frame from that of the sensor mounted on it, with the base at
/// the first scan as the odometry frame: T_base_sensor T_odom_sensor T_base_sensor^-1. Velocity and
/// covariance are then of the base, in the base frame.
Estimate in_base_frame(const Estimate& sensor, const Pose& T_base_sensor);

}  // namespace lilo
