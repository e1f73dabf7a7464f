#pragma once

#include "drivers/scan_source.hpp"

namespace lilo {

/// Scans of the KITTI odometry benchmark: NNNNNN.bin, each float32 x y z intensity per point. The
/// authors have moved all points to one instant, times.txt gives it (0.1 s steps without one).
/// `folder` holds the scans, or is sequences/NN with velodyne/ in it. Storage order, which is ring
/// after ring, is kept. Throws DriverError when there is no scan or times.txt is not numbers.
std::unique_ptr<ScanSource> open_kitti_scans(const std::string& folder, const SensorConfig& config);

}  // namespace lilo
