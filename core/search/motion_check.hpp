// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/constants.hpp"
#include "core/motion/scan_timing.hpp"
#include "core/pose.hpp"
#include "core/search/hypothesis.hpp"
#include "core/search/top_down_grid.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lilo::core {

/// Whether the last scans agree better under another motion than the one tracked.
///
/// Where little structure stands beside a road, a truck ahead has more features that tell the
/// motion along the road than all posts together. The alignment may then follow the truck: the
/// truck fits, and the posts count as moving. But if the scans of the last half second are laid
/// over each other as they were tracked, everything that is fixed leaves a trail, and the scans
/// share more cells under another motion along the road.
///
/// Not thread-safe; no allocation after construction.
class MotionCheck {
 public:
  /// `most_features`: of one scan.
  explicit MotionCheck(std::size_t most_features);

  void clear();
  /// The next scan as it was tracked. If its returns were compensated, both poses are the last one.
  void add(const std::vector<Feature>& features, const Pose& T_begin, const Pose& T_end,
           const ScanTiming& timing);
  /// To be called once after each add(). Whether another motion was significantly better both now
  /// and the last time. `axis`: horizontal unit vector along or across the surroundings.
  bool is_refuted(const Eigen::Vector2d& axis);

 private:
  struct Scan {
    TopDownPoints points;
    Eigen::Vector2d begin_m, end_m;
    double span_s = 0.0;
    std::int64_t end_ns = 0;
  };
  void lay(const Scan& scan, const Displacement& more, Subsample subsample);
  int occupied_under(const Displacement& more, Subsample subsample);
  int least_occupied(const Eigen::Vector2d& axis, Subsample subsample);
  bool is_clearly_better(const Eigen::Vector2d& axis);

  std::array<Scan, search::kMotionScans> scans_;
  std::size_t count_ = 0, newest_ = 0;
  int times_refuted_ = 0;      // on end
  StructurePoints structure_;  // of the newest
  TopDownGrid grid_;
};

}  // namespace lilo::core
