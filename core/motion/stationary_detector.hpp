// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/motion/motion_prior.hpp"
#include "core/pose.hpp"

namespace lilo::core {

/// Whether the sensor is stationary, and the hypothesis that it still is.
///
/// When most of the structure beside a stationary sensor sets off slowly, as the lanes of a jam do,
/// an alignment that begins at the last pose and velocity follows it a little more every scan. From
/// the place where the sensor was stationary, the structure that is fixed fits exactly.
class StationaryDetector {
 public:
  /// The sensor is assumed to be stationary there.
  void assume(const Pose& T_odom_sensor);
  void reset();
  /// A pose was found, and the twist at its end.
  void observe(const Pose& T_odom_sensor, const Twist& twist);

  [[nodiscard]] bool is_stationary() const { return is_stationary_; }
  /// The prior of a sensor that is still at that place and hardly moves. What is known of rotation
  /// stays.
  [[nodiscard]] Prior hypothesis(Prior prior) const;

 private:
  Pose T_odom_sensor_;  // where it is stationary
  int slow_scans_ = 0;  // in a row
  bool is_stationary_ = false;
};

}  // namespace lilo::core
