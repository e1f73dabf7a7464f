// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/estimate.hpp"

#include <Eigen/Core>

namespace lilo::core {

/// Whether the sensor is stationary. Such a sensor is waited for while scans are missing.
class StationaryDetector {
 public:
  /// The sensor is assumed to be stationary there.
  void assume(const Eigen::Vector3d& place_m);
  void reset();
  /// The place where it was found, and its twist there.
  void observe(const Eigen::Vector3d& place_m, const Twist& twist);

  [[nodiscard]] bool is_stationary() const { return is_stationary_; }

 private:
  Eigen::Vector3d place_m_ = Eigen::Vector3d::Zero();  // where it is stationary
  int slow_scans_ = 0;                                 // in a row
  bool is_stationary_ = false;
};

}  // namespace lilo::core
