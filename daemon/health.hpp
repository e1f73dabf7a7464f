// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/odometry.hpp"
#include "daemon/json_writer.hpp"
#include "daemon/realtime.hpp"
#include "daemon/recent.hpp"
#include "drivers/scan_builder.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace lilo {

/// What comes through from the sensor to the poses: the first thing that does not.
enum class Flow : std::uint8_t {
  all,         ///< poses are of now
  no_packets,  ///< nothing came for a second
  no_scans,    ///< packets come, but no revolution ended for 1.5 s
  no_poses,    ///< scans come, but the worker has finished none for two seconds
};

/// What can go wrong again and again, and is counted. In the order in which it is told.
enum class Fault : std::uint8_t {
  wrong_sensor_packets,
  foreign_packets,
  packets_lost,
  kernel_dropped,
  malformed_packets,
  receive_errors,
  sensor_restarts,
  scans_dropped,
  map_refused,
  poses_not_sent,
  send_errors,
  clock_steps,
};
inline constexpr std::size_t kFaultCount = 12;

/// Of each Fault, how many.
struct FaultCounts {
  std::array<std::uint64_t, kFaultCount> counts{};

  std::uint64_t& operator[](Fault fault) { return counts[static_cast<std::size_t>(fault)]; }
  std::uint64_t operator[](Fault fault) const { return counts[static_cast<std::size_t>(fault)]; }
};

/// How the daemon is, once a second. Counts are totals since the start of the process.
struct Health {
  std::int64_t stamp_ns = 0;  ///< UTC
  std::string instance;       ///< name of this daemon among those of one computer
  double uptime_s = 0.0;
  Flow flow = Flow::all;
  TrackingStatus tracking = TrackingStatus::initializing;  ///< of the last pose
  ClockSource clock = ClockSource::host;
  double sensor_silent_s = 0.0;  ///< since the last packet; since the start when there was none
  double pose_age_s = -1.0;      ///< since the last pose was sent; negative: there was none

  SensorStatus sensor;
  DriverCounts driver;
  SourceCounts source;
  std::uint64_t scans_processed = 0, scans_dropped = 0;
  std::uint64_t map_refused = 0;                              ///< Estimate::map_refused_count
  double tilt_deg = 0.0;                                      ///< Odometry::tilt_rad()
  bool has_beams = false;                                     ///< errors of the beams are estimated
  double beams_elevation_deg = 0.0, beams_azimuth_deg = 0.0;  ///< largest correction
  std::uint64_t poses_sent = 0, poses_not_sent = 0, send_errors = 0;
  std::uint64_t clock_steps = 0;  ///< the computer's UTC was set while it ran
  double clock_step_s = 0.0;      ///< the last of them
  std::size_t ring_slots = 0, ring_high_water = 0, clients = 0;
  std::uint64_t clients_refused = 0;   ///< subscriptions beyond subscribe.max_clients
  std::uint64_t packets_sent = 0;      ///< the sensor's, to subscribers that asked for them,
  std::uint64_t packets_not_sent = 0;  ///< and those they missed because we were behind
  double rate_hz = 0.0;                ///< poses in the last second
  FaultCounts totals;                  ///< of the counts above, those that are faults
  FaultCounts recent;                  ///< in the last ten seconds

  Quantiles latency_ms, processing_ms;  ///< of the last minute
  std::array<Quantiles, kStageCount> stages_ms;

  RealtimeReport realtime;
  std::uint64_t worker_minor_faults = 0;  ///< since its tenth scan
  std::uint64_t major_faults = 0;         ///< of the process, since it was ready
  double resident_mb = 0.0;
  bool config_error = false;   ///< the file was bad at the last reload: the old one is in force
  bool metrics_error = false;  ///< the metrics file could not be written
};

/// One word for how it is now: `silent`, `no_scans`, `no_poses`, or the tracking status.
const char* status_word(const Health& health);

/// An HDL-64E whose table has not been read from its packets yet: they cannot be used.
bool waits_for_calibration(const SensorStatus& sensor);

/// The health datagram of PROTOCOL.md. When there is no room, the stages go, then the last
/// complaints.
std::string_view write_health(const std::string& session, const Health& health, JsonWriter& out);

const char* to_string(ClockSource clock);
/// "vlp16", "hdl64e", as sensor.model has them; "" while it is not known.
const char* to_string(SensorModel model);
const char* to_string(ReturnMode mode);

}  // namespace lilo
