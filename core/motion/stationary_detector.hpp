// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/estimate.hpp"
#include "core/pose.hpp"

namespace lilo::core {

/// Whether the sensor is stationary. Such a sensor is waited for while scans are missing.
class StationaryDetector {
 public:
  /// The sensor is assumed to be stationary there.
  void assume(const Pose& T_odom_sensor);
  void reset();
  /// A pose was found, and the twist at its end.
  void observe(const Pose& T_odom_sensor, const Twist& twist);

  [[nodiscard]] bool is_stationary() const { return is_stationary_; }

 private:
  Pose T_odom_sensor_;  // where it is stationary
  int slow_scans_ = 0;  // in a row
  bool is_stationary_ = false;
};

}  // namespace lilo::core
