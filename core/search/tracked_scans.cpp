// SPDX-License-Identifier: BSD-3-Clause
#include "core/search/tracked_scans.hpp"

#include <algorithm>

namespace lilo::core {

TrackedScans::TrackedScans(std::size_t most_features) {
  for (TrackedScan& scan : scans_) scan.points.reserve(most_features);
}

void TrackedScans::add(const StructurePoints& structure, const Pose& T_begin, const Pose& T_end,
                       const ScanTiming& timing) {
  newest_ = (newest_ + 1) % scans_.size();
  count_ = std::min(count_ + 1, scans_.size());
  TrackedScan& scan = scans_[newest_];
  // Where someone carries the sensor, the yaw rate changes from scan to scan. One attitude for all
  // points would smear fixed things differently in every scan, and two motions would seem to fit.
  scan.points.assign_turning(structure, T_begin.rotation, T_end.rotation, Subsample::all);
  scan.begin_m = T_begin.translation_m.head<2>();
  scan.end_m = T_end.translation_m.head<2>();
  scan.span_s = timing.span_s();
  scan.end_ns = timing.end_ns;
}

/// From the end of the newest scan.
void TrackedScans::lay(const TrackedScan& scan, const Eigen::Vector2d& faster_mps,
                       Subsample subsample, TopDownGrid& grid) const {
  const TrackedScan& newest = scans_[newest_];
  const double ago_s = seconds_between(scan.end_ns, newest.end_ns);
  grid.add(scan.points, scan.begin_m - newest.end_m - (ago_s + scan.span_s) * faster_mps,
           scan.end_m - newest.end_m - ago_s * faster_mps, subsample);
}

int TrackedScans::occupied_under(const Eigen::Vector2d& faster_mps, Subsample subsample,
                                 TopDownGrid& grid, int limit) const {
  grid.clear();
  for (const TrackedScan& scan : scans_) {
    lay(scan, faster_mps, subsample, grid);
    if (grid.occupied() >= limit) return limit;
  }
  return grid.occupied();
}

int TrackedScans::occupied_at(double speed_mps, const Eigen::Vector2d& along, Subsample subsample,
                              TopDownGrid& grid, int limit) const {
  const TrackedScan& newest = scans_[newest_];
  const Eigen::Vector2d across(-along.y(), along.x());
  const auto place_m = [&](const Eigen::Vector2d& tracked_m, double ago_s) {
    return across.dot(tracked_m - newest.end_m) * across - ago_s * speed_mps * along;
  };
  grid.clear();
  for (const TrackedScan& scan : scans_) {
    const double ago_s = seconds_between(scan.end_ns, newest.end_ns);
    grid.add(scan.points, place_m(scan.begin_m, ago_s + scan.span_s), place_m(scan.end_m, ago_s),
             subsample);
    if (grid.occupied() >= limit) return limit;
  }
  return grid.occupied();
}

int TrackedScans::occupied_alone(TopDownGrid& grid) const {
  int occupied = 0;
  for (const TrackedScan& scan : scans_) {
    grid.clear();
    lay(scan, Eigen::Vector2d::Zero(), Subsample::all, grid);
    occupied += grid.occupied();
  }
  return occupied;
}

}  // namespace lilo::core
