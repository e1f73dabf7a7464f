// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/constants.hpp"
#include "core/motion/scan_timing.hpp"
#include "core/pose.hpp"
#include "core/search/top_down_grid.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace lilo::core {

/// The structure of a scan, with the poses between which it was measured.
struct TrackedScan {
  TopDownPoints points;
  Eigen::Vector2d begin_m, end_m;
  double span_s = 0.0;
  std::int64_t end_ns = 0;
};

/// The last scans as they were tracked, laid over each other under other motions.
///
/// Not thread-safe; no allocation after construction.
class TrackedScans {
 public:
  /// `most_features`: of one scan.
  explicit TrackedScans(std::size_t most_features);

  void clear() { count_ = 0; }
  /// The next scan; it replaces the oldest.
  void add(const StructurePoints& structure, const Pose& T_begin, const Pose& T_end,
           const ScanTiming& timing);
  [[nodiscard]] bool is_full() const { return count_ == scans_.size(); }
  /// Cells that all scans occupy together, as though the sensor had been faster than tracked by
  /// `faster_mps` (odometry's axes); `limit` if they are as many or more. To be called only if
  /// is_full().
  int occupied_under(const Eigen::Vector2d& faster_mps, Subsample subsample, TopDownGrid& grid,
                     int limit = std::numeric_limits<int>::max()) const;
  /// The same, as though the sensor had moved at a constant `speed_mps` along the unit vector
  /// `along`, and as tracked across it.
  int occupied_at(double speed_mps, const Eigen::Vector2d& along, Subsample subsample,
                  TopDownGrid& grid, int limit = std::numeric_limits<int>::max()) const;
  /// The sum of the cells that each scan occupies alone.
  int occupied_alone(TopDownGrid& grid) const;

 private:
  std::array<TrackedScan, search::kMotionScans> scans_;
  std::size_t count_ = 0, newest_ = 0;
};

}  // namespace lilo::core
