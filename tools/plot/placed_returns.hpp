// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/pose.hpp"
#include "core/scan.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace lilo {

/// Puts the returns of scans where a trajectory says they are, each at its own firing time between
/// the last pose and this one, unless the scan says that this has been done.
class ReturnPlacer {
 public:
  /// For the next scan; `T_odom_sensor` is the sensor's pose at scan.end_ns.
  void next(const Scan& scan, const Pose& T_odom_sensor);

  /// In the odometry frame (m).
  [[nodiscard]] Eigen::Vector3d place(const Return& r) const {
    const auto slot = static_cast<std::size_t>(std::max(0.0, r.t_ns / slot_ns_));
    return poses_[std::min(slot, poses_.size() - 1)] *
           Eigen::Vector3f(r.x_m, r.y_m, r.z_m).cast<double>();
  }

 private:
  bool any_ = false;
  Pose previous_;
  std::int64_t previous_ns_ = 0;
  double slot_ns_ = 1.0;
  std::vector<Pose> poses_;
};

}  // namespace lilo
