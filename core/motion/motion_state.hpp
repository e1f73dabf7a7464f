// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/motion/motion_prior.hpp"
#include "core/motion/scan_timing.hpp"

#include <cstdint>
#include <optional>

namespace lilo::core {

/// What is known before the first scan. The pose is the origin by definition. Vehicles go fast
/// along the ground and turn about the vertical, and hardly move otherwise.
KnotInformation initial_information();

/// What is known of the sensor's motion at the last firing of a scan.
struct MotionState {
  Pose T_odom_sensor;                                   ///< from where the map was begun
  Twist twist;                                          ///< in the sensor's frame
  KnotInformation information = initial_information();  ///< of the pose and its rate
  std::optional<std::int64_t> end_ns;  ///< of that firing; none before the first scan
};

/// The prior of a scan after a known state: constant velocity with white noise on acceleration of
/// power density `density` (ProcessNoise::density()), in as many segments as segments_for() says.
/// The reported pose gets the same density until the caller says otherwise.
Prior predict(const MotionState& state, const ScanTiming& scan, const Vector6d& density,
              int least_segments);

/// What may have happened in a gap that is not predicted: covariance of the motion (rotation,
/// translation) along the odometry's axes. The sensor may have gone on at its twist: so far is one
/// sigma. That twist is not known exactly, and acceleration was white noise (q t^3 / 3).
Matrix6d covariance_over_gap(const MotionState& state, const Prior& prior);

/// The predicted pose of the last firing.
Pose predicted_end(const Prior& prior);
/// The predicted state after the scan.
MotionState predicted_state(const Prior& prior, std::int64_t end_ns);

}  // namespace lilo::core
