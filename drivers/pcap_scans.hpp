// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/scan_source.hpp"

namespace lilo {

/// Scans of a capture. The fragments at both ends are left out; partial scans between are not.
std::unique_ptr<ScanSource> open_pcap_scans(const std::string& path, const SensorConfig& config);

}  // namespace lilo
