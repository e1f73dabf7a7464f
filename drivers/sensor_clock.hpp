// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/scan.hpp"

#include <cstdint>

namespace lilo {

/// The sensor's microseconds past the hour as an unbroken time line, and that line as UTC.
///
/// Two steps, so that no clock can bend a scan: unwrap() puts stamps on the sensor's own line
/// (differences there are exact, whatever the computer's clock does), to_utc_ns() shifts the line.
/// The shift changes only in begin_scan().
///
/// - gps: GPRMC and PPS place the hour; the sensor's clock is UTC.
/// - host, sensor within half a second of the computer: the sensor is set by something we do not
///   hear (PPS without NMEA, a data set); its minutes are right and the computer gives the hour.
/// - host otherwise: the sensor counts from its own start. The first packet's receive time places
///   the line, and the line follows the computer's clock slowly (1e-4) once they differ by 2 ms.
class SensorClock {
 public:
  /// The instant on the sensor's line nearest to what came before; the hour wraps by nearness,
  /// never by "smaller than before", so reordered packets and stamps past 3600 s are right.
  std::int64_t unwrap(std::uint32_t stamp_us, std::int64_t received_ns);

  /// GPS says that it was `gps_utc_ns` (to a second or two) when the sensor's clock was `stamp_us`.
  void gps_fix(std::uint32_t stamp_us, std::int64_t gps_utc_ns, std::int64_t received_ns);

  /// Between scans: takes over what was learnt of the computer's and GPS's clock.
  void begin_scan(std::int64_t line_ns);

  /// The sensor's clock jumped: forget the line.
  void restart();

  [[nodiscard]] std::int64_t to_utc_ns(std::int64_t line_ns) const { return line_ns + shift_ns_; }
  [[nodiscard]] ClockSource source() const {
    return use_gps_ ? ClockSource::gps : ClockSource::host;
  }

 private:
  [[nodiscard]] bool gps_is_fresh(std::int64_t line_ns) const;
  void follow_host();

  bool started_ = false;
  std::int64_t last_line_ns_ = 0, last_received_ns_ = 0;

  std::int64_t shift_ns_ = 0;
  bool placed_ = false;        // shift_ns_ has been chosen
  bool free_running_ = false;  // the sensor's minutes mean nothing
  bool use_gps_ = false;

  bool gps_heard_ = false;
  std::int64_t gps_shift_ns_ = 0, gps_line_ns_ = 0;

  // Of the scan now being received: the smallest of receive time minus sensor time, that is, the
  // packet that waited least.
  bool has_delay_ = false;
  std::int64_t least_delay_ns_ = 0;
  int scans_astray_ = 0;
};

}  // namespace lilo
