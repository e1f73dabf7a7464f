// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/run/odometry_run.hpp"

#include <string>

namespace lilo {

/// The statistics file of `lilo run`. CPU times are those of the one thread that does it all.
/// `cpu_ms_per_scan` and `total_ms` cover decode (reading included) to pose.
std::string to_json(const OdometryRun& run);

/// The short table for people.
std::string to_text(const OdometryRun& run);

}  // namespace lilo
