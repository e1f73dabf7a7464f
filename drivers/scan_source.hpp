// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/scan.hpp"
#include "drivers/scan_builder.hpp"
#include "drivers/sensor_config.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace lilo {

/// When the first and the last packet read so far were captured, by the capturing computer's clock.
struct ReceivedSpan {
  std::int64_t first_ns = 0, last_ns = 0;  ///< UTC; 0 while there is none
};

/// Scans of a recording, as fast as they can be read. The revolutions at both ends of a pcap that
/// were not recorded whole are left out: the first scan is the first complete revolution.
class ScanSource {
 public:
  ScanSource() = default;
  ScanSource(const ScanSource&) = delete;
  ScanSource& operator=(const ScanSource&) = delete;
  virtual ~ScanSource() = default;

  /// Fills `scan` with the next one; false at the end, and what `scan` holds then is of no use.
  virtual bool next(Scan& scan) = 0;
  [[nodiscard]] virtual DriverCounts driver_counts() const = 0;
  [[nodiscard]] virtual SourceCounts source_counts() const = 0;
  /// What the capture says of the sensor; nothing for data sets.
  [[nodiscard]] virtual SensorStatus sensor_status() const { return {}; }
  /// Of the capture's packets; nothing for data sets.
  [[nodiscard]] virtual ReceivedSpan received() const { return {}; }
  /// See PacketSource; empty for data sets.
  [[nodiscard]] virtual std::string link_type() const { return {}; }
  /// Part of the recording already read, in [0, 1]; 0 where that cannot be known.
  [[nodiscard]] virtual double progress() const = 0;
  /// Why the recording ended early, one line for the user; empty while nothing is wrong.
  [[nodiscard]] virtual std::string error() const { return {}; }
};

/// `path`: a pcap ("-" for standard input), a folder of NNNNNN.bin scans, a KITTI sequences/NN
/// folder (velodyne/, times.txt) or a KITTI raw drive (velodyne_points/). Throws DriverError with
/// one line for the user.
std::unique_ptr<ScanSource> open_scans(const std::string& path, const SensorConfig& config);

}  // namespace lilo
