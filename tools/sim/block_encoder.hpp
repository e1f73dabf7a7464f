// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/calibration.hpp"
#include "tools/sim/encoder.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lilo::sim {

/// A sensor whose blocks hold 32 lasers of one firing sequence each: VLP-32C and HDL-32E one block
/// a sequence, VLS-128 four.
struct BlockSensor {
  Sensor sensor;
  std::uint8_t product;
  std::size_t banks;
  double distance_step_m;
  std::int64_t sequence_ns, group_ns;
  std::size_t lasers_a_group, groups_before_pause;
  std::int64_t stamp_delay_ns;  ///< of the stamp after the first firing; negative: after the end
  double pivot_m;               ///< beams meet the axis this far behind the lenses
  std::span<const double> elevation_deg;
  std::span<const double> azimuth_deg;  ///< clockwise of the head; repeats

  [[nodiscard]] std::int64_t firing_ns(std::size_t laser) const {
    const std::size_t group = laser / lasers_a_group;
    return static_cast<std::int64_t>(group + group / groups_before_pause) * group_ns;
  }
};

/// Null where the sensor has another encoder.
const BlockSensor* find_block_sensor(Sensor sensor);
/// The beams by channel, as a calibration table.
std::vector<LaserCorrection> block_calibration(const BlockSensor& sensor);

/// Their packets. Dual return doubles each block: the last return, then the strongest, or the
/// second strongest where they are one; what the VLS-128 leaves of the packet is zero.
class BlockEncoder : public Encoder {
 public:
  BlockEncoder(const Rig& rig, const BlockSensor& sensor);

  Packet encode(std::int64_t start_ns) override;
  [[nodiscard]] std::int64_t period_ns() const override {
    return static_cast<std::int64_t>(sequences()) * sensor_.sequence_ns;
  }

 private:
  [[nodiscard]] bool is_dual() const { return rig_.options.returns == ReturnMode::dual; }
  [[nodiscard]] std::size_t blocks_a_sequence() const {
    return sensor_.banks * (is_dual() ? 2 : 1);
  }
  [[nodiscard]] std::size_t sequences() const { return 12 / blocks_a_sequence(); }
  void fill_sequence(Packet& packet, std::size_t block, std::int64_t start_ns);
  void put(Packet& packet, std::size_t block, std::size_t channel, const Echo& echo) const;
  Shot shoot(std::size_t laser, std::int64_t time_ns);

  Rig rig_;
  const BlockSensor& sensor_;
  std::vector<LaserCorrection> lasers_;
};

}  // namespace lilo::sim
