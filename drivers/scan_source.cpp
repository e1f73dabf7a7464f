// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/scan_source.hpp"

#include "drivers/kitti_scans.hpp"
#include "drivers/pcap_scans.hpp"

#include <filesystem>

namespace lilo {

std::unique_ptr<ScanSource> open_scans(const std::string& path, const SensorConfig& config) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return open_kitti_scans(path, config);
  return open_pcap_scans(path, config);
}

}  // namespace lilo
