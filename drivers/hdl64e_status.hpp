// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/calibration.hpp"

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>

namespace lilo {

/// Puts together what an HDL-64E tells in the last two bytes of each packet, a type and a value (S3
/// manual rev. K, pages 31-38): 16 packets are a cycle (H M S D N Y G T V and seven bytes of the
/// table), 260 cycles are a lap of 4160 packets, about 1.2 s.
///
/// The place of a byte in the lap is counted from the packets' stamps, lost ones included, so a
/// loss costs its own byte and no more; the next lap fills it. The types check the count. The lap
/// begins at the marker "UNIT#", which may come after the bytes it places: one lap is enough,
/// wherever it starts.
class Hdl64eStatus {
 public:
  enum class Table : std::uint8_t {
    incomplete,
    refused,    ///< checksum or a value is wrong; counting starts again
    checked,    ///< S3: the checksum holds
    unchecked,  ///< S2: no checksum, the last bytes say 1820
    repeated,   ///< S2: neither, but two laps were the same
  };

  /// One packet's status, `lost` packets after the one before. `has_checksum`: the model is an S3,
  /// so a table whose checksum fails is refused.
  Table see(std::uint8_t type, std::uint8_t value, std::uint32_t lost, bool has_checksum);
  /// The stamps jumped: places are unknown.
  void restart();

  /// The table, once see() has said that it is whole.
  [[nodiscard]] const Calibration& calibration() const { return calibration_; }

  /// UTC of the second named by the cycle that just ended, when it was whole and the sensor has
  /// GPS time and pulse ('A'). Given once.
  std::optional<std::int64_t> take_gps_utc_ns();

  [[nodiscard]] std::uint8_t firmware() const { return firmware_; }
  [[nodiscard]] std::uint8_t temperature_c() const { return temperature_c_; }
  /// Part of the table that is known, in [0, 1].
  [[nodiscard]] double progress() const;

  static constexpr std::size_t kCycle = 16, kCycles = 260, kLap = kCycle * kCycles;
  static constexpr std::size_t kTimeSlots = 9, kTableSlots = kCycle - kTimeSlots;
  static constexpr std::size_t kTableBytes = kCycles * kTableSlots;

 private:
  [[nodiscard]] bool phase_holds(std::uint8_t type);
  void note_time(std::uint8_t type, std::uint8_t value);
  void note_byte(std::uint8_t value);
  void find_marker();
  Table judge(bool has_checksum);
  [[nodiscard]] std::array<std::uint8_t, kTableBytes> table_bytes() const;

  std::size_t position_ = 0;  // of this packet, in laps from an arbitrary start
  bool started_ = false;
  std::optional<std::size_t> phase_;   // position_ % 16 at which a cycle begins
  std::optional<std::size_t> origin_;  // position_ at which the lap begins
  std::array<std::uint8_t, kLap> values_{};
  std::bitset<kLap> seen_, seen_twice_;
  std::size_t seen_count_ = 0, seen_twice_count_ = 0;  // bits set: asked with every packet
  bool judged_ = false;
  Calibration calibration_;

  std::array<std::uint8_t, 7> time_{};  // H M S D N Y G
  std::size_t time_count_ = 0;
  std::optional<std::int64_t> gps_utc_ns_;
  std::uint8_t firmware_ = 0, temperature_c_ = 0;
};

/// CRC-16, polynomial 0x8005, from 0, most significant bit first.
std::uint16_t crc16(const std::uint8_t* bytes, std::size_t count, std::uint16_t crc = 0);

}  // namespace lilo
