#pragma once

#include "core/odometry.hpp"
#include "daemon/json_writer.hpp"
#include "daemon/realtime.hpp"
#include "daemon/recent.hpp"
#include "drivers/scan_builder.hpp"

#include <boost/container/static_vector.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace lilo {

/// How the daemon is, once a second. Counts are totals since the start of the process.
struct Health {
  std::int64_t stamp_ns = 0;  ///< UTC
  double uptime_s = 0.0;
  TrackingStatus status = TrackingStatus::initializing;
  ClockSource clock = ClockSource::host;
  double sensor_silent_s = 0.0;  ///< since the last packet; since the start when there was none

  double calibration_progress = 1.0;  ///< below 1: waiting for the table of an HDL-64E

  DriverCounts driver;
  SourceCounts source;
  std::uint64_t scans_processed = 0, scans_dropped = 0;
  std::uint64_t map_refused = 0;  ///< Estimate::map_refused_count
  std::uint64_t poses_sent = 0, poses_not_sent = 0, send_errors = 0;
  std::size_t ring_slots = 0, ring_high_water = 0, clients = 0;
  double rate_hz = 0.0;  ///< poses in the last second

  Quantiles latency_ms, processing_ms;  ///< of the last minute
  std::array<Quantiles, kStageCount> stages_ms;

  RealtimeReport realtime;
  std::uint64_t worker_minor_faults = 0;  ///< since its tenth scan
  std::uint64_t major_faults = 0;         ///< of the process, since it was ready
  double resident_mb = 0.0;
  bool config_error = false;   ///< the file was bad at the last reload: the old one is in force
  bool metrics_error = false;  ///< the metrics file could not be written
};

/// What keeps `health` from being good, in words; empty when nothing does.
using Complaints = boost::container::static_vector<std::string_view, 11>;
Complaints complaints(const Health& health);

/// The health datagram of PROTOCOL.md.
std::string_view write_health(const std::string& session, const Health& health, JsonWriter& out);

/// The same for Prometheus' node_exporter, in its text format, in place of what `out` held. It
/// keeps its memory: from the second time on, nothing is allocated.
void write_prometheus(const std::string& session, const Health& health, std::string& out);

const char* to_string(ClockSource clock);

}  // namespace lilo
