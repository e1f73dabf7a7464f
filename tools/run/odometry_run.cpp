#include "tools/run/odometry_run.hpp"

#include "tools/clock.hpp"

#include <fstream>
#include <sstream>
#include <string>

namespace lilo {
namespace {

/// VmHWM of /proc/self/status; 0 where the kernel does not say.
double peak_rss_mb() {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    if (!line.starts_with("VmHWM:")) continue;
    double kib = 0.0;
    std::istringstream(line.substr(6)) >> kib;
    return kib * 1024e-6;
  }
  return 0.0;
}

}  // namespace
OdometryRun run_odometry(ScanSource& source, const OdometryConfig& config, const SeenScan& seen) {
  OdometryRun run;
  Odometry odometry(config);
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
    ++run.status_counts[static_cast<std::size_t>(estimate.status)];
    seen(scan, estimate);
  }
  run.wall_s = static_cast<double>(busy_ns) * 1e-9;
  run.peak_rss_mb = peak_rss_mb();
  run.failure = source.error();
  run.driver_counts = source.driver_counts();
  run.source_counts = source.source_counts();
  return run;
}

}  // namespace lilo
