// SPDX-License-Identifier: BSD-3-Clause
#include "core/motion/stationary_detector.hpp"

#include "core/constants.hpp"

namespace lilo::core {

void StationaryDetector::assume(const Eigen::Vector3d& place_m) {
  place_m_ = place_m;
  is_stationary_ = true;
}

void StationaryDetector::reset() {
  is_stationary_ = false;
  slow_scans_ = 0;
}

void StationaryDetector::observe(const Eigen::Vector3d& place_m, const Twist& twist) {
  if (is_stationary_) {
    if ((place_m - place_m_).norm() > motion::kSetOff_m) reset();
    return;
  }
  const bool slow = twist.linear_mps.norm() < motion::kStationary_mps &&
                    twist.angular_radps.norm() < motion::kStationary_radps;
  slow_scans_ = slow ? slow_scans_ + 1 : 0;
  if (slow_scans_ >= motion::kStationaryScans) assume(place_m);
}

}  // namespace lilo::core
