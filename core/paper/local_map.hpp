// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/paper/features.hpp"

#include <pcl/kdtree/kdtree_flann.h>

#include <vector>

namespace lilo::paper {

/// One of the two local maps P^l_E and P^l_S of Section 4: a voxel-reduced cloud in the odometry
/// frame and its kd-tree. Both are rebuilt at every update.
class LocalMap {
 public:
  LocalMap(double voxel_m, double radius_m) : voxel_m_(voxel_m), radius_m_(radius_m) {}

  /// Adds points of the sensor's frame at `T_odom_sensor`, reduces, and removes what is farther
  /// than the map's radius from the sensor along x, y or z (Section 5: 100 m "in the x, y, z
  /// axes").
  void update(const std::vector<const Cloud*>& clouds, const Pose& T_odom_sensor);

  /// Map points within `radius_m` of `point` (Section 4: 1.0 m), unordered. The result lives until
  /// the next call.
  const std::vector<int>& neighbours(const Point& point, double radius_m) const;

  [[nodiscard]] const Cloud& cloud() const { return *cloud_; }

 private:
  double voxel_m_;
  double radius_m_;
  Cloud::Ptr cloud_{new Cloud};
  pcl::KdTreeFLANN<Point> tree_{false};  // unsorted: a covariance knows no order
  mutable std::vector<int> indices_;
  mutable std::vector<float> squared_distances_;
};

}  // namespace lilo::paper
