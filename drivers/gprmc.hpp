// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace lilo {

/// What a GPS receiver says of the second that just began.
struct GpsTime {
  std::int64_t utc_ns = 0;
  bool valid = false;  ///< status A: the receiver has a fix
};

/// Reads a $GPRMC (or $GNRMC) sentence: NMEA 0183, fields 1 (hhmmss), 2 (A/V), 9 (ddmmyy).
/// Nothing when it is no such sentence, a field is out of range or the checksum is wrong; a
/// sentence without a checksum is taken. Ends at CR, LF, NUL or the end of the text.
std::optional<GpsTime> parse_gprmc(std::string_view text);

/// Seconds since 1970 of a civil date and time, UTC. `year` in full.
std::int64_t utc_seconds(int year, int month, int day, int hour, int minute, int second);

}  // namespace lilo
