// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/constants.hpp"
#include "core/map/cell_map.hpp"
#include "core/motion/motion_state.hpp"
#include "core/motion/trajectory.hpp"
#include "core/search/hypothesis.hpp"
#include "core/search/top_down_grid.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

namespace lilo::core {

/// When the sensor departed from the prediction: before the scan, while it was unseen, so that the
/// whole scan is displaced; or within the scan, in which it began to turn.
enum class Onset : std::uint8_t { before_scan, within_scan };

/// How far a displacement may go, to either side.
struct SearchRadius {
  double along_m = 0.0, yaw_rad = 0.0;
  double begin_yaw_rad = 0.0;  ///< for Onset::within_scan
};

/// Searches where in the map the sensor may be, after a while without an alignment.
///
/// Scan and map are laid over each other on a top-down grid. At the true place the structure of the
/// scan falls on that of the map. All displacements within the radius are scored on a map drawn
/// thick; the best of them are refined on a thinner one. A quarter of the points is used. The
/// places found are for alignments to begin from: of two walls that look alike, either may be
/// right.
///
/// Not thread-safe; no allocation after construction.
class DisplacementSearch {
 public:
  /// Any yaw, and as far as a vehicle may depart from its prediction in the longest gap.
  static inline const SearchRadius kFarthest{
      0.5 * search::kMostAcceleration_mps2 * motion::kLongestGap_s * motion::kLongestGap_s,
      std::numbers::pi, 0.0};

  /// `most_features`: of one scan.
  explicit DisplacementSearch(std::size_t most_features);

  /// Draws the map: the structure within 128 m of `center_m` along either axis. Its coarse cells
  /// are enough.
  void set_map(const CellMap& structure, const Eigen::Vector3d& center_m);

  /// The most likely displacements from the predicted place, the best one first, no two of them
  /// alike, none farther than kFarthest. The result lives until the next call.
  std::span<const Displacement> find(const std::vector<Feature>& features,
                                     const Trajectory& predicted, const SearchRadius& radius,
                                     Onset onset = Onset::before_scan);

 private:
  void try_all(const SearchRadius& radius);
  void refine_best(int along);
  void choose();
  void try_turned(const Displacement& turned, int farthest);
  void turn(TopDownGrid& map, const Displacement& turned);
  void score(const TopDownGrid& map, const Displacement& by);

  Eigen::Vector2d center_m_ = Eigen::Vector2d::Zero();
  TopDownGrid map_, thick_map_;
  StructurePoints structure_;
  TopDownPoints points_;
  Pose begin_, end_;  // as predicted
  Onset onset_ = Onset::before_scan;
  std::vector<Hypothesis> hypotheses_;
  std::array<Displacement, search::kMostPlaces> found_;
  std::size_t found_count_ = 0;
};

}  // namespace lilo::core
