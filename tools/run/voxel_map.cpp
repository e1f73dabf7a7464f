// SPDX-License-Identifier: BSD-3-Clause
#include "tools/run/voxel_map.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lilo {
namespace {

/// False when the key was there; the table has room.
bool take(std::vector<std::uint64_t>& table, std::uint64_t key) {
  const std::size_t mask = table.size() - 1;
  auto at = static_cast<std::size_t>(key * 0x9E3779B97F4A7C15ULL >> 20U) & mask;
  for (; table[at] != 0; at = (at + 1) & mask) {
    if (table[at] == key) return false;
  }
  table[at] = key;
  return true;
}

}  // namespace

std::uint64_t VoxelMap::voxel_of(const Eigen::Vector3f& p_m) const {
  const auto part = [&](float v_m) {
    const auto cell = std::llround(std::floor(static_cast<double>(v_m) / voxel_m_));
    return static_cast<std::uint64_t>(cell + (1 << 20)) & 0x1FFFFFU;
  };
  // 21 bits an axis: 200 km of voxels of 10 cm. The top bit tells it from an empty place.
  return 1ULL << 63U | part(p_m.x()) | part(p_m.y()) << 21U | part(p_m.z()) << 42U;
}

void VoxelMap::add(const Scan& scan, const Pose& T_odom_sensor) {
  placer_.next(scan, T_odom_sensor);
  for (const Return& r : scan.returns) insert({placer_.place(r).cast<float>(), r.intensity});
}

void VoxelMap::insert(const MapPoint& point) {
  constexpr std::size_t kFirstTable = 1U << 16U;
  if (!point.position_m.allFinite()) return;
  if (2 * (points_.size() + 1) > taken_.size()) {
    taken_.assign(std::max(kFirstTable, 2 * taken_.size()), 0);
    for (const MapPoint& old : points_) take(taken_, voxel_of(old.position_m));
  }
  if (!take(taken_, voxel_of(point.position_m))) return;
  points_.push_back(point);
  if (points_.size() > most_) thin_out();
}

void VoxelMap::thin_out() {
  voxel_m_ *= 1.5;
  const std::vector<MapPoint> all = std::exchange(points_, {});
  std::fill(taken_.begin(), taken_.end(), 0);
  for (const MapPoint& point : all) {
    if (take(taken_, voxel_of(point.position_m))) points_.push_back(point);
  }
}

}  // namespace lilo
