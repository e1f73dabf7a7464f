// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/calibration.hpp"
#include "tools/sim/options.hpp"

#include <cstdint>
#include <vector>

namespace lilo::sim {

/// CRC-16 with polynomial 0x8005, start 0, no reflection (S3 manual, appendix E).
std::uint16_t crc16(const std::vector<std::uint8_t>& bytes);

/// The last two bytes of an HDL-64E packet: a type and a value, one pair a packet. 16 packets are a
/// cycle (date, time, GPS, temperature, firmware version, seven bytes of the table); 260 cycles
/// carry the whole calibration (S3 manual rev. K, pp. 31-38).
class StatusBytes {
 public:
  struct Pair {
    std::uint8_t type, value;
  };

  StatusBytes(const SensorOptions& options, const std::vector<LaserCorrection>& lasers);

  /// Pair of the `index`-th packet after power-up, sent at `utc_s`.
  [[nodiscard]] Pair at(std::uint64_t index, std::int64_t utc_s) const;

  static constexpr std::uint64_t kLap = std::uint64_t{260} * 16;

 private:
  void add_table(const std::vector<LaserCorrection>& lasers);
  void add_settings(const SensorOptions& options);
  void add(std::initializer_list<int> values);
  void set_type(std::size_t from_end, std::uint8_t type);

  bool has_gps_;
  bool is_s3_;
  std::vector<Pair> table_;  ///< 260 x 7: everything but date, time and state
};

}  // namespace lilo::sim
