// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace lilo {

/// Times of a KITTI folder's scans or poses, one a line, line k for number k: times.txt of a
/// sequence in seconds ("1.037359e+00"), timestamps.txt of a raw drive as date and time
/// ("2011-09-26 13:02:25.594360375"; KITTI does not say the time zone, it is taken for UTC). An
/// empty line is that of a scan that is missing from the drive.
using KittiTimes = std::vector<std::optional<std::int64_t>>;

/// Empty where there is no such file. Throws DriverError naming file and line.
KittiTimes read_kitti_times(const std::filesystem::path& file);

}  // namespace lilo
