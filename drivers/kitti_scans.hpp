#pragma once

#include "drivers/scan_source.hpp"

namespace lilo {

/// Scans of KITTI: NNNNNN.bin, each float32 x y z intensity per point. In the odometry benchmark
/// and in raw "sync" drives the authors have moved all points to one instant, so scans are marked
/// motion_compensated and are never deskewed again; times.txt or timestamps.txt gives the instant
/// (0.1 s steps without one). `folder` holds the scans, or is sequences/NN with velodyne/ in it, or
/// a raw drive with velodyne_points/data in it. Storage order, which is ring after ring, is kept.
/// SensorConfig::kitti_elevation_offset_rad is added to every ray's elevation.
/// Throws DriverError when there is no scan or a line of the times is none.
std::unique_ptr<ScanSource> open_kitti_scans(const std::string& folder, const SensorConfig& config);

}  // namespace lilo
