// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/scan_source.hpp"

namespace lilo {

/// Scans of KITTI: NNNNNN.bin, each float32 x y z intensity per point. `folder` holds them, or is
/// sequences/NN with velodyne/ in it, or a raw drive with velodyne_points/data in it.
/// - Odometry benchmark: the authors have moved all points to one instant, which times.txt gives
///   (0.1 s steps without it). Scans are marked motion_compensated and never deskewed again; the
///   order of storage, which is ring after ring, is kept. Scans beside nothing else count as these.
/// - Raw drives: points are as measured. They get times and the order of firing (kitti_sweeps.hpp).
/// SensorConfig::kitti_elevation_offset_rad is added to every ray's elevation.
/// Throws DriverError when there is no scan or the times are not as they should be.
std::unique_ptr<ScanSource> open_kitti_scans(const std::string& folder, const SensorConfig& config);

}  // namespace lilo
