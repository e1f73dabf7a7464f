// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/pose.hpp"
#include "core/scan.hpp"
#include "tools/plot/placed_returns.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lilo {

/// A point of a map to keep.
struct MapPoint {
  Eigen::Vector3f position_m;  ///< odometry frame
  std::uint8_t intensity = 0;  ///< of the first return in the voxel, as the sensor sent it
};

/// The whole drive's map: the first return in every voxel. Memory is bounded: when there are more
/// than `most` points, the voxels grow by half and the points are thinned out.
class VoxelMap {
 public:
  explicit VoxelMap(double voxel_m, std::size_t most = 50'000'000)
      : voxel_m_(voxel_m), most_(most) {}

  /// `T_odom_sensor` is the sensor's pose at scan.end_ns.
  void add(const Scan& scan, const Pose& T_odom_sensor);

  [[nodiscard]] const std::vector<MapPoint>& points() const { return points_; }
  [[nodiscard]] double voxel_m() const { return voxel_m_; }

 private:
  void insert(const MapPoint& point);
  void thin_out();
  [[nodiscard]] std::uint64_t voxel_of(const Eigen::Vector3f& p_m) const;

  double voxel_m_;
  std::size_t most_;
  ReturnPlacer placer_;
  std::vector<MapPoint> points_;
  std::vector<std::uint64_t> taken_;  // hash set of voxels, 0: empty
};

}  // namespace lilo
