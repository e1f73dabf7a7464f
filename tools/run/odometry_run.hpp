// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/odometry.hpp"
#include "drivers/scan_source.hpp"
#include "tools/run/stage_timer.hpp"
#include "tools/trajectory.hpp"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace lilo {

/// A recording taken through the odometry.
struct OdometryRun {
  std::vector<StampedPose> poses;                ///< one a scan
  std::vector<TrackingStatus> statuses;          ///< of each
  std::array<std::uint64_t, 4> status_counts{};  ///< scans, by TrackingStatus
  DriverCounts driver_counts;
  SourceCounts source_counts;
  StageTimer timer;
  /// What bounds time and memory, a value a scan: entries of the map, residuals, Gauss-Newton
  /// steps, memory of this process after it (10^6 bytes).
  std::vector<double> map_size, correspondences, iterations, rss_mb;
  double wall_s = 0.0;       ///< of reading, decoding and odometry; what `seen` does is left out
  double recorded_s = 0.0;   ///< from the first firing to the last
  double peak_rss_mb = 0.0;  ///< most memory of this process up to here, 10^6 bytes
  BeamEstimate beams;        ///< what was found of them
  double tilt_rad = 0.0;     ///< as Odometry::tilt_rad()
  std::string failure;  ///< why the recording ended early, ScanSource::error(); empty: it did not
};

/// Called after every scan.
using SeenScan = std::function<void(const Scan&, const Estimate&)>;

/// Takes every scan of the source through a new odometry, as fast as it goes, on this thread.
/// `kept`: as in Odometry::resume_beams(); default: nothing.
OdometryRun run_odometry(ScanSource& source, const OdometryConfig& config, const SeenScan& seen,
                         const BeamEstimate& kept = {});

}  // namespace lilo
