// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/sensor_status.hpp"
#include "drivers/sensor_table.hpp"
#include "drivers/wire.hpp"

#include <cstddef>

namespace lilo {

/// How the blocks of a packet are shared out, by the return mode.
struct PacketLayout {
  ReturnMode mode = ReturnMode::strongest;
  int bank_stride = 1;      ///< from a bank's block to the next bank's
  int blocks_per_shot = 1;  ///< a shot: the blocks that share an azimuth
  int shots = 0;            ///< 0: no packet was seen

  [[nodiscard]] bool is_dual() const { return mode == ReturnMode::dual; }
};

/// `packet` has wire::kDataPacketBytes, as in all of these. `before` is the layout of the packet
/// before: a head that stands still does not tell the mode, so the old one holds.
PacketLayout find_layout(const SensorTable& table, const std::byte* packet,
                         const PacketLayout& before);

/// False: a block's flag or azimuth is not one that this sensor sends.
bool is_whole(const SensorTable& table, const std::byte* packet, const PacketLayout& layout);

/// Ticks, as sent.
inline int shot_azimuth(const std::byte* packet, const PacketLayout& layout, int shot) {
  return wire::block_azimuth(packet, shot * layout.blocks_per_shot);
}

}  // namespace lilo
