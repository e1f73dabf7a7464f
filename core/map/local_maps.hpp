// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/feature.hpp"
#include "core/map/cell_map.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lilo::core {

/// The levels of the map at which a feature is matched: at the first one that gives information.
enum class Levels : std::uint8_t {
  from_whole,  ///< whole cells, then coarse ones
  from_half,   ///< half cells, then whole ones, then coarse ones
  first_known  ///< the same, but the first one with enough points decides, also if it gives none
};

/// The local map: cells of several sizes, of ground and of structure apart.
///
/// Memory is reserved at construction. Not thread-safe.
class LocalMaps {
 public:
  /// Half cells, whole cells and coarse cells. Half cells are used in rooms, where three whole
  /// cells blur walls, doors and furniture into one another, and after a scan with a weak
  /// direction.
  static constexpr std::size_t kLevels = 3;
  static constexpr std::size_t kHalf = 0, kWhole = 1, kCoarse = 2;
  using PerLevel = std::array<std::int32_t, kLevels>;
  static constexpr PerLevel kNoCells{CellMap::kNone, CellMap::kNone, CellMap::kNone};
  static constexpr std::size_t finest_of(Levels levels) {
    return levels == Levels::from_whole ? kWhole : kHalf;
  }

  /// `configs`: of each level the ground map, then the structure map.
  explicit LocalMaps(const std::array<std::array<CellMapConfig, 2>, kLevels>& configs);

  [[nodiscard]] CellMap& at(std::size_t level, FeatureKind kind) {
    return levels_[level][static_cast<std::size_t>(kind)];
  }
  [[nodiscard]] const CellMap& at(std::size_t level, FeatureKind kind) const {
    return levels_[level][static_cast<std::size_t>(kind)];
  }

  /// Adds features to the level `finest` and to all coarser ones. Points and gaps are in the
  /// odometry frame.
  struct Point {
    Eigen::Vector3d point_m;
    Eigen::Vector3f gap_m;
    FeatureKind kind;
    Eigen::Vector3f ray =
        Eigen::Vector3f::Zero();  ///< unit vector from the sensor; zero: not known
    Sensitivity sensitivity = Sensitivity::Zero();
  };
  void insert(std::span<const Point> points, std::size_t finest);

  void end_keyframe();
  /// Forgets cells farther than `radius_m` from `center_m`, half cells farther than
  /// map::kHalfCellRadius_m.
  void forget_beyond(const Eigen::Vector3d& center_m, double radius_m);
  /// Subtracts the rigid motion from the sensitivity of every point.
  void subtract_sensitivity(const PoseSensitivity& rigid);
  void clear();
  [[nodiscard]] int size() const;               ///< cells
  [[nodiscard]] std::uint64_t refused() const;  ///< points that found no room
  /// The mean of every whole cell (m, odometry frame), in no particular order.
  template <typename Visit>
  void for_each_mean(const Visit& visit) const {
    for (const CellMap& map : levels_[kWhole]) map.for_each_mean(visit);
  }

 private:
  std::array<std::vector<CellMap>, kLevels> levels_;  // by FeatureKind
};

}  // namespace lilo::core
