// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/gprmc.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace lilo {

/// The 512-byte packet on port 8308 (VLP-16 manual 9.3.3: stamp at 0xC6, PPS at 0xCA, NMEA at
/// 0xCE).
struct PositionPacket {
  std::uint32_t stamp_us = 0;  ///< past the hour, by the sensor's clock
  bool pps_locked = false;
  std::optional<GpsTime> gps;

  /// The sensor's clock runs with GPS: its hour can be taken from the sentence.
  [[nodiscard]] bool synchronized() const { return pps_locked && gps && gps->valid; }
};

/// Nothing when the size is wrong or the stamp is impossible.
std::optional<PositionPacket> parse_position_packet(std::span<const std::byte> payload);

}  // namespace lilo
