#pragma once

#include "core/map/cell_map.hpp"
#include "core/motion/trajectory.hpp"
#include "core/search/footprint.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

namespace lilo::core {

/// How a pose differs from the one predicted: moved along the ground and turned about the upright.
/// Odometry axes. A whole scan is moved alike; from its first firing to its last the turn changes
/// evenly.
struct Displacement {
  Eigen::Vector2d along_m = Eigen::Vector2d::Zero();
  double yaw_rad = 0.0;        ///< of the last firing
  double begin_yaw_rad = 0.0;  ///< of the first
};
Pose displaced(const Pose& T, const Displacement& by);

/// What the sensor may have done other than predicted: turned and moved while it was unseen, then
/// the whole scan is displaced; or begun to turn during this scan.
enum class Change : std::uint8_t { before, during };

/// How far a displacement may go, either way.
struct Reach {
  double along_m = 0.0, yaw_rad = 0.0;
  double begin_yaw_rad = 0.0;  ///< for Change::during
};

/// Where in the map the sensor may be, when nothing told for a while how it moved.
///
/// Scan and map are seen from above, as Footprint does: where the sensor is, the returns of what
/// stands fall on what stood there before. Displacements all over the reach are tried on a map
/// drawn thick, and those around the best of them on one drawn finer, with a quarter of the
/// returns. What is found is for alignments to begin from: of two walls that are alike, either may
/// be right.
///
/// Not thread-safe; no allocation after construction.
class Relocalizer {
 public:
  static constexpr std::size_t kMostPlaces = 3;
  static constexpr Reach kFarthest{12.5, std::numbers::pi, 0.0};

  /// `most_features`: of one scan.
  explicit Relocalizer(std::size_t most_features);

  /// What stands within 128 m of `center_m` along either axis; a cell of it is 1.5 m at most.
  void set_map(const CellMap& structure, const Eigen::Vector3d& center_m);

  /// The likeliest displacements from where the scan was predicted to be, the best one first, all
  /// unlike each other. Farther than kFarthest none is looked for. Lives until the next call.
  std::span<const Displacement> search(const std::vector<Feature>& features,
                                       const Trajectory& predicted, const Reach& reach,
                                       Change change = Change::before);

 private:
  struct Look {
    Displacement by;
    int returns = 0;  // that fall on the map
  };
  void look_everywhere(const Reach& reach);
  void look_around_the_best();
  void choose();
  void look_at_turn(const Displacement& turned, int farthest);
  void turn(Footprint& map, const Displacement& turned);
  void look(const Footprint& map, const Displacement& by);

  Eigen::Vector2d center_m_ = Eigen::Vector2d::Zero();
  Footprint map_, thick_map_;
  Outline outline_;
  Plan plan_;
  Pose begin_, end_;  // as predicted
  Change change_ = Change::before;
  std::vector<Look> looks_;
  std::array<Displacement, kMostPlaces> places_;
  std::size_t place_count_ = 0;
};

}  // namespace lilo::core
