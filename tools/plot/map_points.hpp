// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/pose.hpp"
#include "core/scan.hpp"
#include "tools/plot/placed_returns.hpp"

#include <vector>

namespace lilo {

/// Returns of some of the scans, put where the trajectory says they are: what a picture of the map
/// is drawn from. Memory is bounded: when there are too many points, every second one goes, and
/// from then on only every second one comes.
class MapPoints {
 public:
  /// `pose` is the sensor's at scan.end_ns. Scans nearer than half a metre to the last one taken
  /// are left out. Returns are moved to their own firing time between the last pose and this one,
  /// unless the scan says that this has been done.
  void add(const Scan& scan, const Pose& pose);

  /// Odom frame, metres.
  [[nodiscard]] const std::vector<Eigen::Vector3f>& points() const { return points_; }

 private:
  [[nodiscard]] bool worth_taking(const Pose& pose) const;
  void thin_out();

  std::vector<Eigen::Vector3f> points_;
  std::size_t stride_ = 1;
  bool any_ = false;
  Pose taken_;
  ReturnPlacer placer_;
};

}  // namespace lilo
