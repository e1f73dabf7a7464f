// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/motion/motion_prior.hpp"
#include "core/motion/scan_timing.hpp"

#include <cstdint>
#include <optional>

namespace lilo::core {

/// What is known before the first scan: the pose is the origin by definition; of the motion, that
/// vehicles go fast along the ground and turn about the vertical, and do little else.
KnotInformation initial_information();

/// What is known of the sensor's motion at the last firing of a scan.
struct MotionState {
  Pose T_odom_sensor;                                   ///< from where the map in force was begun
  Twist twist;                                          ///< in the sensor's frame
  KnotInformation information = initial_information();  ///< of the pose and its rate
  std::optional<std::int64_t> end_ns;  ///< of that firing; none before the first scan
};

/// What the motion before a scan says of the motion during it: constant velocity, with
/// `density` as the power density of the acceleration's white noise (ProcessNoise::density()), in
/// as many segments as that asks for, at least `least_segments`.
Prior predict(const MotionState& state, const ScanTiming& scan, const Vector6d& density,
              int least_segments);

/// The pose of the last firing by the prediction alone.
Pose predicted_end(const Prior& prior);
/// The state after a scan of which nothing but the prediction is known.
MotionState predicted_state(const Prior& prior, std::int64_t end_ns);

}  // namespace lilo::core
