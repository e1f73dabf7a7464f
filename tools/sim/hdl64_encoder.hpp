// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/encoder.hpp"
#include "tools/sim/hdl64_table.hpp"
#include "tools/sim/status_bytes.hpp"

#include <array>
#include <vector>

namespace lilo::sim {

/// HDL-64E S2 and S3 packets: pairs of an upper (0xEEFF) and a lower (0xDDFF) block that fire
/// together and share an azimuth; four shots a group within a bank; raw ranges, to be corrected
/// with the unit's table; a status pair at the end. Single return: six firings a packet. Dual (S3):
/// three, each as upper, lower, upper, lower: strongest first, then last (second strongest where
/// they are one).
class Hdl64Encoder : public Encoder {
 public:
  /// `start_utc_ns` is for the status bytes' date; `status_index` where their cycle starts.
  Hdl64Encoder(const Rig& rig, std::vector<LaserCorrection> lasers, std::int64_t start_utc_ns,
               std::uint64_t status_index);

  Packet encode(std::int64_t start_ns) override;
  [[nodiscard]] std::int64_t period_ns() const override;
  void power_up() override { status_index_ = 0; }

  /// After the packet's first firing. The manual does not say which instant the stamp is; the end
  /// of the packet, as VeloView reads it and as the shared sets have it.
  [[nodiscard]] std::int64_t stamp_delay_ns() const { return period_ns(); }

 private:
  struct Firing {
    std::size_t block;  ///< of the upper bank; the lower one follows
    std::int64_t time_ns;
    double azimuth_deg;
  };
  void fire_pair(Packet& packet, const Firing& firing);
  void put(Packet& packet, std::size_t block, std::size_t channel, const Echo& echo) const;
  /// The shot of one laser with raw ranges.
  [[nodiscard]] Shot shoot(const LaserCorrection& laser, const Placement& pose, double azimuth_deg,
                           double time_s);
  [[nodiscard]] bool is_dual() const { return rig_.options.returns == ReturnMode::dual; }

  Rig rig_;
  std::vector<LaserCorrection> lasers_;
  StatusBytes status_;
  std::int64_t start_utc_ns_;
  std::uint64_t status_index_;
  std::int64_t pair_ns_;
  std::array<std::int64_t, 32> shot_ns_{};  ///< of each channel after its block's first
};

}  // namespace lilo::sim
