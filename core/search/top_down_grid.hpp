// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/constants.hpp"
#include "core/feature.hpp"

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <vector>

/// How well scans agree with each other, or with the map, under a hypothesis of the motion.
namespace lilo::core {

/// The structure features of a scan, each in the sensor's frame at its firing. An array per
/// coordinate, so that several are moved at a time. Every fourth comes first, then the others.
struct StructurePoints {
  std::vector<float> x_m, y_m, z_m;
  std::vector<float> s;  ///< as Feature::s

  /// How many of `size` come before `part`: all for search::kSubsample.
  static std::size_t before(std::size_t part, std::size_t size);
  void reserve(std::size_t size);
  /// Leaves ground out: it looks the same at every speed.
  void assign(const std::vector<Feature>& features);
};

/// How many of the points are used. A quarter is enough to tell motions apart that differ clearly.
enum class Subsample : std::uint8_t { quarter, all };

/// Structure points in the axes of the odometry, seen from above, in cells from the sensor. Motions
/// that differ in speed alone share them.
struct TopDownPoints {
  std::vector<float> x, y;
  std::vector<float> s;  ///< as Feature::s

  void reserve(std::size_t size);
  /// Of a scan in which the sensor turned from `begin` to `end`. All points are turned by the
  /// attitude in the middle, which is enough at a constant rate. Points outside the subsample are
  /// left as they were.
  void assign(const StructurePoints& scan, const Eigen::Quaterniond& begin,
              const Eigen::Quaterniond& end, Subsample subsample);
  /// The same, each point by the nearest of search::kTurnInstants attitudes: for a rate that
  /// changes from scan to scan.
  void assign_turning(const StructurePoints& scan, const Eigen::Quaterniond& begin,
                      const Eigen::Quaterniond& end, Subsample subsample);
};

/// A square grid of 256 m seen from above, on which scans are laid under a motion. Trunks and walls
/// of several scans share cells under the true motion and smear under any other. It needs neither a
/// map nor an initial guess, and hardly depends on how many rings hit an object.
///
/// Not thread-safe; no allocation after construction.
class TopDownGrid {
 public:
  /// `most`: the most points of one scan.
  explicit TopDownGrid(std::size_t most);

  /// Cells occupied by all scans added since clear().
  [[nodiscard]] int occupied() const { return occupied_; }
  void clear();

  /// Adds one scan during which the sensor moved from `begin_m` to `end_m` at constant velocity.
  /// Points outside the grid are left out, and so are more than `most` points.
  void add(const TopDownPoints& scan, const Eigen::Vector2d& begin_m, const Eigen::Vector2d& end_m,
           Subsample subsample = Subsample::all);
  /// Adds one point, and all cells within `around` of its own.
  void add(const Eigen::Vector2d& point_m, int around);
  /// Remembers where the points of a scan fall, except within `margin` cells of the border.
  void place(const TopDownPoints& scan, const Eigen::Vector2d& begin_m,
             const Eigen::Vector2d& end_m, Subsample subsample, int margin);
  /// How many of the points placed fall on occupied cells, moved by so many cells, at most
  /// `margin`.
  [[nodiscard]] int hits(int x, int y) const;

 private:
  std::vector<std::int32_t> at_;
  std::size_t placed_ = 0;  // how many of them place() remembered
  // Of each cell, the count of clear() at which it was last occupied. So clear() need not empty the
  // cells, and no cell waits for a write to its neighbour, as the bits of one word would.
  std::vector<std::uint8_t> taken_;
  std::uint8_t now_ = 0;
  int occupied_ = 0;
};

}  // namespace lilo::core
