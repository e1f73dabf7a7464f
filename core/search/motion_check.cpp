// SPDX-License-Identifier: BSD-3-Clause
#include "core/search/motion_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lilo::core {

MotionCheck::MotionCheck(std::size_t most_features) : grid_(most_features) {
  for (Scan& scan : scans_) scan.points.reserve(most_features);
  structure_.reserve(most_features);
}

void MotionCheck::clear() {
  count_ = 0;
  times_refuted_ = 0;
}

void MotionCheck::add(const std::vector<Feature>& features, const Pose& T_begin, const Pose& T_end,
                      const ScanTiming& timing) {
  newest_ = (newest_ + 1) % search::kMotionScans;
  count_ = std::min(count_ + 1, search::kMotionScans);
  Scan& scan = scans_[newest_];
  structure_.assign(features);
  scan.points.assign(structure_, T_begin.rotation, T_end.rotation);
  scan.begin_m = T_begin.translation_m.head<2>();
  scan.end_m = T_end.translation_m.head<2>();
  scan.span_s = timing.span_s();
  scan.end_ns = timing.end_ns;
}

/// As though the sensor had moved by so much more in each second, from the end of the newest scan.
void MotionCheck::lay(const Scan& scan, const Displacement& more, Subsample subsample) {
  const Scan& newest = scans_[newest_];
  const double ago_s = seconds_between(scan.end_ns, newest.end_ns);
  grid_.add(scan.points, scan.begin_m - newest.end_m - (ago_s + scan.span_s) * more.along_m,
            scan.end_m - newest.end_m - ago_s * more.along_m, subsample);
}

int MotionCheck::occupied_under(const Displacement& more, Subsample subsample) {
  grid_.clear();
  for (const Scan& scan : scans_) lay(scan, more, subsample);
  return grid_.occupied();
}

/// Under motions that are faster or slower along the axis, or across it.
int MotionCheck::least_occupied(const Eigen::Vector2d& axis, Subsample subsample) {
  int least = std::numeric_limits<int>::max();
  for (const double speed_mps : search::kFalseMotions_mps) {
    const Eigen::Vector2d along_m = speed_mps * axis;
    const Eigen::Vector2d across_m(-along_m.y(), along_m.x());
    for (const Eigen::Vector2d& by_m :
         {along_m, Eigen::Vector2d(-along_m), across_m, Eigen::Vector2d(-across_m)}) {
      least = std::min(least, occupied_under({.along_m = by_m}, subsample));
    }
  }
  return least;
}

bool MotionCheck::is_clearly_better(const Eigen::Vector2d& axis) {
  // A motion that is clearly better with all points is mostly better with a quarter of them too.
  if (least_occupied(axis, Subsample::quarter) >= occupied_under({}, Subsample::quarter)) {
    return false;
  }
  const int tracked = occupied_under({}, Subsample::all);
  const int least = least_occupied(axis, Subsample::all);
  int alone = 0;
  for (const Scan& scan : scans_) {
    grid_.clear();
    lay(scan, {}, Subsample::all);
    alone += grid_.occupied();
  }
  // Scans that hardly have cells in common tell nothing: then the number of all cells counts. The
  // best of sixteen false motions is sometimes two sigmas better when someone carries the sensor.
  return is_significant(alone - least, alone - tracked, search::kPreferSigmas) &&
         tracked - least > search::kDropSigmas * std::sqrt(static_cast<double>(tracked));
}

bool MotionCheck::is_refuted(const Eigen::Vector2d& axis) {
  if (count_ < search::kMotionScans) return false;
  times_refuted_ = is_clearly_better(axis) ? times_refuted_ + 1 : 0;
  return times_refuted_ >= search::kRefutingScans;
}

}  // namespace lilo::core
