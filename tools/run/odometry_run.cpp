// SPDX-License-Identifier: BSD-3-Clause
#include "tools/run/odometry_run.hpp"

#include "tools/clock.hpp"

#include <fstream>
#include <sstream>
#include <string>

namespace lilo {
namespace {

/// A line of /proc/self/status, in 10^6 bytes: VmHWM is the most memory so far, VmRSS what is held
/// now. 0 where the kernel does not say.
double memory_mb(const std::string& name) {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    if (!line.starts_with(name + ':')) continue;
    double kib = 0.0;
    std::istringstream(line.substr(name.size() + 1)) >> kib;
    return kib * 1024e-6;
  }
  return 0.0;
}

void note_size(const Estimate& estimate, OdometryRun& run) {
  run.map_size.push_back(estimate.map_cell_count + estimate.map_edge_count +
                         estimate.map_surface_count);
  run.correspondences.push_back(estimate.correspondence_count);
  run.iterations.push_back(estimate.iterations);
  run.rss_mb.push_back(memory_mb("VmRSS"));
}

}  // namespace

OdometryRun run_odometry(ScanSource& source, const OdometryConfig& config, const SeenScan& seen,
                         const BeamEstimate& kept) {
  OdometryRun run;
  Odometry odometry(config);
  odometry.resume_beams(kept);
  Scan scan;
  std::int64_t busy_ns = 0;
  std::int64_t first_ns = 0;
  for (;;) {
    run.timer.start();
    const std::int64_t begin_ns = monotonic_ns();
    if (!source.next(scan)) break;
    run.timer.decoded();
    const Estimate estimate = odometry.process(scan, run.timer.hook());
    run.timer.finish();
    busy_ns += monotonic_ns() - begin_ns;

    if (run.poses.empty()) first_ns = scan.start_ns;
    run.recorded_s = static_cast<double>(scan.end_ns - first_ns) * 1e-9;
    run.poses.push_back({estimate.stamp_ns, estimate.T_odom_sensor});
    run.statuses.push_back(estimate.status);
    ++run.status_counts[static_cast<std::size_t>(estimate.status)];
    note_size(estimate, run);
    seen(scan, estimate);
  }
  run.wall_s = static_cast<double>(busy_ns) * 1e-9;
  run.peak_rss_mb = memory_mb("VmHWM");
  run.beams = odometry.beam_estimate();
  run.tilt_rad = odometry.tilt_rad();
  run.failure = source.error();
  run.driver_counts = source.driver_counts();
  run.source_counts = source.source_counts();
  return run;
}

}  // namespace lilo
