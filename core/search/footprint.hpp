#pragma once

#include "core/image/feature_image.hpp"

#include <Eigen/Geometry>

#include <cstdint>
#include <vector>

/// How well some scans fall on each other under a motion that is only supposed.
namespace lilo::core {

/// What stands in a scan, each in the sensor's frame at its firing. An array per coordinate, so
/// that several are moved at a time. Every fourth comes first, then the others.
struct Outline {
  std::vector<float> x_m, y_m, z_m;
  std::vector<float> s;  ///< as Feature::s

  static constexpr std::size_t kParts = 4;
  /// How many of `size` come before `part`: all for kParts.
  static std::size_t before(std::size_t part, std::size_t size);
  void reserve(std::size_t size);
  /// Ground counts for nothing, it looks the same at every speed.
  void assign(const std::vector<Feature>& features);
};

/// How much of the scans is laid over each other: where motions differ clearly, a part of them
/// tells.
enum class Share : std::uint8_t { quarter, all };

/// An outline turned to the axes of the odometry and seen from above, in cells from the sensor.
/// Motions that differ in speed alone share it.
struct Plan {
  std::vector<float> x, y;
  std::vector<float> s;  ///< as Feature::s

  void reserve(std::size_t size);
  /// Of a scan in which the sensor turned from `begin` to `end`. Other points than those of `share`
  /// keep the places they had.
  void assign(const Outline& scan, const Eigen::Quaterniond& begin, const Eigen::Quaterniond& end,
              Share share = Share::all);
  /// The same for a sensor that may turn fast: each point by the rotation at its firing.
  void assign_turning(const Outline& scan, const Eigen::Quaterniond& begin,
                      const Eigen::Quaterniond& end, Share share);
};

/// The area that what stands takes up on the ground, seen from above, when scans are laid over each
/// other as a motion says: trunks and walls coincide under the true one and smear under any other.
/// Needs neither a map nor a first guess, and hardly cares how many rings hit a thing.
///
/// Not thread-safe; no allocation after construction.
class Footprint {
 public:
  static constexpr int kPerMetre = 2;  ///< cells: as wide as a trunk or a post with its blur

  /// `most`: of one scan.
  explicit Footprint(std::size_t most);

  /// Square cells taken up by all scans added since clear().
  [[nodiscard]] int cells() const { return cells_; }
  void clear();

  /// Adds one scan that lasted from `begin_m` to `end_m`, at constant velocity. What lies 128 m, to
  /// a cell, from the origin along an axis is left out, and so are more than `most`.
  void add(const Plan& scan, const Eigen::Vector2d& begin_m, const Eigen::Vector2d& end_m,
           Share share = Share::all);
  /// Adds one point. Returns within `around` cells of its own fall on it as well.
  void add(const Eigen::Vector2d& point_m, int around);
  /// Remembers where the returns of a scan fall, but for those within `margin` cells of the end.
  void aim(const Plan& scan, const Eigen::Vector2d& begin_m, const Eigen::Vector2d& end_m,
           Share share, int margin);
  /// How many of those fall on what was added, moved by so many cells, `margin` at most.
  [[nodiscard]] int returns_on(int x, int y) const;

 private:
  std::vector<std::int32_t> at_;
  std::size_t aimed_ = 0;  // how many of them aim() remembered
  // Of each cell, at which count of clear() it was last taken up. Nothing need be emptied so, and
  // no cell waits for what was just written of its neighbour, as bits of one word would.
  std::vector<std::uint8_t> taken_;
  std::uint8_t now_ = 0;
  int cells_ = 0;
};

/// How often scans meet under two motions together, of the cells they take up each for itself and
/// under either. Only meetings tell motions apart, and chance moves the difference by their root: a
/// cell is hit or missed by a few returns.
inline int meetings(int cells_alone, int cells, int other_cells) {
  return 2 * cells_alone - cells - other_cells;
}

}  // namespace lilo::core
