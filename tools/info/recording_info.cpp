// SPDX-License-Identifier: BSD-3-Clause
#include "tools/info/recording_info.hpp"

#include <algorithm>

namespace lilo {
namespace {

constexpr double kSecondsPerNs = 1e-9;

double seconds(std::int64_t ns) { return static_cast<double>(ns) * kSecondsPerNs; }

void add_scan(const Scan& scan, const ReceivedSpan& received, RecordingInfo& info) {
  if (info.scans == 0) {
    info.first_ns = scan.start_ns;
    // The scan was handed on when its last packet had been read.
    info.first_after_s =
        seconds(received.last_ns - received.first_ns) - seconds(scan.end_ns - scan.start_ns);
  }
  info.last_ns = scan.end_ns;
  info.motion_compensated = scan.motion_compensated;
  ++info.scans;
  ++info.clock_scans[static_cast<std::size_t>(scan.clock)];
  info.returns += scan.returns.size();
  info.rings = std::max(info.rings, scan.beams.ring_count);
  if (scan.packets.lost == 0) return;
  info.losses.push_back({.scan = scan.index,
                         .after_s = info.first_after_s + seconds(scan.start_ns - info.first_ns),
                         .start_ns = scan.start_ns,
                         .packets = scan.packets.lost,
                         .hole_width_rad = static_cast<double>(scan.hole_width_rad)});
}

void find_rpm(std::vector<double>& rpm, RecordingInfo& info) {
  if (rpm.empty()) return;
  const auto middle = rpm.begin() + static_cast<std::ptrdiff_t>(rpm.size() / 2);
  std::nth_element(rpm.begin(), middle, rpm.end());
  info.rpm = *middle;
  info.rpm_min = *std::min_element(rpm.begin(), rpm.end());
  info.rpm_max = *std::max_element(rpm.begin(), rpm.end());
}

}  // namespace

RecordingInfo read_recording(ScanSource& source, const std::function<void(const Scan&)>& seen) {
  RecordingInfo info;
  std::vector<double> rpm;
  const auto note_mode = [&] {
    const SensorStatus status = source.sensor_status();
    if (status.model != SensorModel::automatic)
      info.return_modes[static_cast<std::size_t>(status.return_mode)] = true;
  };
  Scan scan;
  while (source.next(scan)) {
    add_scan(scan, source.received(), info);
    // From first firing to last is a turn but for one firing, less than 0.1 percent.
    if (scan.complete && scan.end_ns > scan.start_ns)
      rpm.push_back(60.0 / seconds(scan.end_ns - scan.start_ns));
    note_mode();
    seen(scan);
  }
  note_mode();
  find_rpm(rpm, info);
  info.sensor = source.sensor_status();
  info.driver_counts = source.driver_counts();
  info.source_counts = source.source_counts();
  info.received = source.received();
  info.link_type = source.link_type();
  info.failure = source.error();
  std::uint64_t lost_in_scans = 0;
  for (const ScanLoss& loss : info.losses) lost_in_scans += loss.packets;
  info.late_for_scan = info.driver_counts.packets_late;
  const std::uint64_t lost =
      info.driver_counts.packets_lost + info.late_for_scan + info.driver_counts.packets_blind;
  info.lost_outside_scans = lost - std::min(lost, lost_in_scans);
  return info;
}

}  // namespace lilo
