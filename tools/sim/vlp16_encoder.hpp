// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/calibration.hpp"
#include "tools/sim/encoder.hpp"

#include <array>
#include <vector>

namespace lilo::sim {

/// The beams by channel, as a calibration table.
std::vector<LaserCorrection> vlp16_calibration(Sensor sensor);

/// VLP-16 and Puck Hi-Res packets as the user manual (63-9243) lays them out: 12 blocks of 100
/// bytes, two firing sequences of 16 lasers a block, stamp of the first firing, return mode and
/// product byte.
class Vlp16Encoder : public Encoder {
 public:
  explicit Vlp16Encoder(const Rig& rig);

  Packet encode(std::int64_t start_ns) override;
  [[nodiscard]] std::int64_t period_ns() const override;

  static constexpr std::int64_t kFiring_ns = 2'304;     ///< from laser to laser
  static constexpr std::int64_t kSequence_ns = 55'296;  ///< 16 firings and 18.432 us of recharging
  static constexpr double kBeamPivot_m = 0.04191;       ///< beams meet this far behind the lenses

 private:
  struct Beam {
    SinCos elevation;
    double offset_z_m;
  };
  void fill_block(Packet& packet, std::size_t block, std::int64_t start_ns);

  Rig rig_;
  std::array<Beam, 16> beams_{};
};

}  // namespace lilo::sim
