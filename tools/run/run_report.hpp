#pragma once

#include "tools/run/odometry_run.hpp"

#include <string>

namespace lilo {

/// Most memory this process has had, in MB (10^6 bytes): VmHWM of /proc/self/status.
double peak_rss_mb();

/// The statistics file of `lilo run`. CPU times are those of the one thread that does it all.
/// `cpu_ms_per_scan` and `total_ms` cover decode (reading included) to pose.
std::string to_json(const OdometryRun& run);

/// The short table for people.
std::string to_text(const OdometryRun& run);

}  // namespace lilo
