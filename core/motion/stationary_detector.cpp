// SPDX-License-Identifier: BSD-3-Clause
#include "core/motion/stationary_detector.hpp"

#include "core/constants.hpp"

namespace lilo::core {

void StationaryDetector::assume(const Pose& T_odom_sensor) {
  T_odom_sensor_ = T_odom_sensor;
  is_stationary_ = true;
}

void StationaryDetector::reset() {
  is_stationary_ = false;
  slow_scans_ = 0;
}

void StationaryDetector::observe(const Pose& T_odom_sensor, const Twist& twist) {
  if (is_stationary_) {
    const Eigen::Vector3d moved_m = T_odom_sensor.translation_m - T_odom_sensor_.translation_m;
    if (moved_m.norm() > motion::kSetOff_m) reset();
    return;
  }
  const bool slow = twist.linear_mps.norm() < motion::kStationary_mps &&
                    twist.angular_radps.norm() < motion::kStationary_radps;
  slow_scans_ = slow ? slow_scans_ + 1 : 0;
  if (slow_scans_ >= motion::kStationaryScans) assume(T_odom_sensor);
}

}  // namespace lilo::core
