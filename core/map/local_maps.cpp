// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/local_maps.hpp"

#include "core/constants.hpp"

#include <algorithm>

namespace lilo::core {
namespace {

constexpr std::size_t kAtATime = 16;  // so that the memory's answers overlap

}  // namespace

LocalMaps::LocalMaps(const std::array<std::array<CellMapConfig, 2>, kLevels>& configs) {
  for (std::size_t level = 0; level < kLevels; ++level) {
    for (const CellMapConfig& config : configs[level]) levels_[level].emplace_back(config);
  }
}

void LocalMaps::insert(std::span<const Point> points, std::size_t finest) {
  struct Waiting {
    std::array<CellMap::CellKey, kLevels> key;
    PerLevel cell;
  };
  std::array<Waiting, kAtATime> waiting;
  while (!points.empty()) {
    const auto some = points.first(std::min(points.size(), kAtATime));
    points = points.subspan(some.size());
    for (std::size_t level = finest; level < kLevels; ++level) {
      for (std::size_t k = 0; k < some.size(); ++k) {
        waiting[k].key[level] = at(level, some[k].kind).key_of(some[k].point_m);
      }
    }
    for (std::size_t level = finest; level < kLevels; ++level) {
      for (std::size_t k = 0; k < some.size(); ++k) {
        waiting[k].cell[level] = at(level, some[k].kind).find_or_insert(waiting[k].key[level]);
      }
    }
    for (std::size_t k = 0; k < some.size(); ++k) {
      const CellMap::SampleGap gap(some[k].gap_m);
      for (std::size_t level = finest; level < kLevels; ++level) {
        at(level, some[k].kind)
            .add(waiting[k].cell[level], waiting[k].key[level], some[k].point_m, gap, some[k].ray,
                 some[k].sensitivity);
      }
    }
  }
}

void LocalMaps::end_keyframe() {
  for (std::vector<CellMap>& level : levels_) {
    for (CellMap& map : level) map.end_keyframe();
  }
}

void LocalMaps::forget_beyond(const Eigen::Vector3d& center_m, double radius_m) {
  for (std::size_t level = 0; level < kLevels; ++level) {
    const double within_m = level == kHalf ? std::min(radius_m, map::kHalfCellRadius_m) : radius_m;
    for (CellMap& map : levels_[level]) map.forget_beyond(center_m, within_m);
  }
}

void LocalMaps::subtract_sensitivity(const PoseSensitivity& rigid) {
  for (std::vector<CellMap>& level : levels_) {
    for (CellMap& map : level) map.subtract_sensitivity(rigid);
  }
}

void LocalMaps::clear() {
  for (std::vector<CellMap>& level : levels_) {
    for (CellMap& map : level) map.clear();
  }
}

int LocalMaps::size() const {
  int cells = 0;
  for (const std::vector<CellMap>& level : levels_) {
    for (const CellMap& map : level) cells += map.size();
  }
  return cells;
}

std::uint64_t LocalMaps::refused() const {
  std::uint64_t points = 0;
  for (const std::vector<CellMap>& level : levels_) {
    for (const CellMap& map : level) points += map.refused();
  }
  return points;
}

}  // namespace lilo::core
