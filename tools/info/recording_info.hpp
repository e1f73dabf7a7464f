// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/scan_source.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace lilo {

/// A scan that misses packets.
struct ScanLoss {
  std::uint64_t scan = 0;     ///< Scan::index
  double after_s = 0.0;       ///< start of the scan after the capture's first packet, by the sensor
  std::int64_t start_ns = 0;  ///< the same instant in UTC, as Scan::start_ns
  std::uint32_t packets = 0;  ///< lost
  double hole_width_rad = 0.0;  ///< Scan::hole_width_rad
};

/// What a recording holds, found by reading all of it.
struct RecordingInfo {
  SensorStatus sensor;  ///< at the end of the recording
  DriverCounts driver_counts;
  SourceCounts source_counts;
  ReceivedSpan received;
  std::string link_type;  ///< see PacketSource
  std::string failure;    ///< why the recording ended early; empty when it did not

  std::array<bool, 3> return_modes{};          ///< seen, by ReturnMode
  std::array<std::uint64_t, 3> clock_scans{};  ///< scans by ClockSource
  bool motion_compensated = false;             ///< the last scan's, Scan::motion_compensated
  std::uint64_t scans = 0;                     ///< whole and partial ones
  std::uint64_t returns = 0;                   ///< in all scans
  int rings = 0;
  std::int64_t first_ns = 0, last_ns = 0;  ///< start of the first scan, end of the last; UTC
  double first_after_s = 0.0;  ///< start of the first scan after the capture's first packet
  double rpm = 0.0, rpm_min = 0.0, rpm_max = 0.0;  ///< of complete scans: median, extremes
  std::vector<ScanLoss> losses;                    ///< in the order of time
  std::uint64_t lost_outside_scans = 0;            ///< before, between and after the scans
  std::uint64_t late_for_scan = 0;  ///< came, but after the scan they belong to was over
};

/// Reads `source` to its end. `seen` is called after every scan.
RecordingInfo read_recording(ScanSource& source, const std::function<void(const Scan&)>& seen);

}  // namespace lilo
