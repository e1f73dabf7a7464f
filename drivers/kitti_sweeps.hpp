// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/scan.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

/// When the returns of KITTI's raw drives were measured. "sync" only means that there is a scan for
/// every picture: the points are as the sensor measured them.
namespace lilo {

/// One turn of the sensor, from straight behind the car to straight behind it.
struct KittiSweep {
  std::int64_t start_ns, end_ns;
};

/// Of the scans with these numbers, in their order. `folder` is a drive's velodyne_points: its
/// timestamps_start.txt and timestamps_end.txt tell; without these, timestamps.txt (when the sensor
/// looked ahead) and a turn of 0.1 s around it; without that, steps of 0.1 s.
/// Throws DriverError where one of the two is missing, a scan has no time, or a turn is not between
/// 0 and 1 s long.
std::vector<KittiSweep> kitti_sweeps(const std::filesystem::path& folder,
                                     const std::vector<std::uint64_t>& numbers);

/// Gives the returns the times at which a beam that turns clockwise, seen from above, and began
/// straight behind pointed to them, and sorts them by time; of equal ones the order is kept.
/// `span_ns`: the turn's, at most 2 s.
void time_kitti_returns(Returns& returns, std::int64_t span_ns);

}  // namespace lilo
