// SPDX-License-Identifier: BSD-3-Clause
#include "core/search/tracked_scans.hpp"

#include <algorithm>

namespace lilo::core {
namespace {

/// Adds a scan. `place_m(tracked_m, ago_s)`: where the sensor was that long before `now_ns`.
template <typename PlaceAt>
void lay(const TrackedScan& scan, std::int64_t now_ns, const PlaceAt& place_m, Subsample subsample,
         TopDownGrid& grid) {
  const double ago_s = seconds_between(scan.end_ns, now_ns);
  grid.add(scan.points, place_m(scan.begin_m, ago_s + scan.span_s), place_m(scan.end_m, ago_s),
           subsample);
}

/// Cells that all scans occupy together; `limit` if they are as many or more.
template <typename Scans, typename PlaceAt>
int occupied_together(const Scans& scans, std::int64_t now_ns, const PlaceAt& place_m,
                      Subsample subsample, TopDownGrid& grid, int limit) {
  grid.clear();
  for (const TrackedScan& scan : scans) {
    lay(scan, now_ns, place_m, subsample, grid);
    if (grid.occupied() >= limit) return limit;
  }
  return grid.occupied();
}

}  // namespace

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

int TrackedScans::occupied_under(const Eigen::Vector2d& faster_mps, Subsample subsample,
                                 TopDownGrid& grid, int limit) const {
  const TrackedScan& newest = scans_[newest_];
  const auto place_m = [&](const Eigen::Vector2d& tracked_m, double ago_s) {
    return Eigen::Vector2d(tracked_m - newest.end_m - ago_s * faster_mps);
  };
  return occupied_together(scans_, newest.end_ns, place_m, subsample, grid, limit);
}

int TrackedScans::occupied_at(double speed_mps, const Eigen::Vector2d& along, Subsample subsample,
                              TopDownGrid& grid, int limit) const {
  const TrackedScan& newest = scans_[newest_];
  const Eigen::Vector2d across(-along.y(), along.x());
  const auto place_m = [&](const Eigen::Vector2d& tracked_m, double ago_s) {
    return Eigen::Vector2d(across.dot(tracked_m - newest.end_m) * across -
                           ago_s * speed_mps * along);
  };
  return occupied_together(scans_, newest.end_ns, place_m, subsample, grid, limit);
}

int TrackedScans::occupied_alone(TopDownGrid& grid) const {
  const TrackedScan& newest = scans_[newest_];
  const auto as_tracked_m = [&](const Eigen::Vector2d& tracked_m, double) {
    return Eigen::Vector2d(tracked_m - newest.end_m);
  };
  int occupied = 0;
  for (const TrackedScan& scan : scans_) {
    grid.clear();
    lay(scan, newest.end_ns, as_tracked_m, Subsample::all, grid);
    occupied += grid.occupied();
  }
  return occupied;
}

}  // namespace lilo::core
