// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/packet_layout.hpp"

#include <algorithm>
#include <cstdint>

namespace lilo {
namespace {

constexpr std::uint8_t kStrongest = 0x37, kLast = 0x38, kDual = 0x39;
// VLS-128: two echoes and a block that says how much to trust them (VeloView).
constexpr std::uint8_t kDualConfirmed = 0x3B;

std::uint8_t mode_byte(const std::byte* packet) { return wire::u8(packet + wire::kTailOffset); }

bool same_azimuth(const std::byte* packet, int i, int j) {
  return wire::block_azimuth(packet, i) == wire::block_azimuth(packet, j);
}

// Its packets name no mode. In dual return mode the two echoes' blocks have one azimuth; where the
// head stands all have.
ReturnMode find_hdl64e_mode(const std::byte* packet, ReturnMode before) {
  const bool pairs =
      same_azimuth(packet, 0, 2) && same_azimuth(packet, 4, 6) && same_azimuth(packet, 8, 10);
  const bool still = same_azimuth(packet, 0, 4) && same_azimuth(packet, 4, 8);
  if (still) return before == ReturnMode::dual ? ReturnMode::dual : ReturnMode::strongest;
  return pairs ? ReturnMode::dual : ReturnMode::strongest;
}

// Where the mode byte is none that is known.
ReturnMode guess_mode(const SensorTable& table, const std::byte* packet) {
  const bool dual = table.banks > 1 ? wire::block_flag(packet, 0) == wire::block_flag(packet, 1)
                                    : same_azimuth(packet, 0, 1) && same_azimuth(packet, 2, 3) &&
                                          !same_azimuth(packet, 0, 2);
  return dual ? ReturnMode::dual : ReturnMode::strongest;
}

ReturnMode find_mode(const SensorTable& table, const std::byte* packet, ReturnMode before) {
  if (table.product == 0) return find_hdl64e_mode(packet, before);
  switch (mode_byte(packet)) {
    case kStrongest:
      return ReturnMode::strongest;
    case kLast:
      return ReturnMode::last;
    case kDual:
      return ReturnMode::dual;
    case kDualConfirmed:
      if (table.has_confidence) return ReturnMode::dual;
      break;
    default:
      break;
  }
  return guess_mode(table, packet);
}

}  // namespace

PacketLayout find_layout(const SensorTable& table, const std::byte* packet,
                         const PacketLayout& before) {
  PacketLayout layout{.mode = find_mode(table, packet, before.mode)};
  if (layout.mode == before.mode && before.shots > 0 && !table.has_confidence) return before;
  if (layout.is_dual() && table.echoes == EchoOrder::last_then_strongest) {
    layout.bank_stride = table.has_confidence && mode_byte(packet) == kDualConfirmed ? 3 : 2;
    layout.blocks_per_shot = layout.bank_stride * table.banks;
  } else {
    layout.blocks_per_shot = (layout.is_dual() ? 2 : 1) * table.banks;
  }
  layout.shots = wire::kBlocks / layout.blocks_per_shot;
  return layout;
}

bool is_whole(const SensorTable& table, const std::byte* packet, const PacketLayout& layout) {
  // With confidence each bank has a third block, which holds no returns.
  const int echoes = std::min(layout.bank_stride, 2);
  const int used = layout.shots * layout.blocks_per_shot;
  for (int first = 0; first < used;) {
    for (int bank = 0; bank < table.banks; ++bank, first += layout.bank_stride) {
      for (int b = first; b < first + echoes; ++b) {
        if (wire::block_flag(packet, b) != table.bank_flags[static_cast<std::size_t>(bank)])
          return false;
        if (wire::block_azimuth(packet, b) >= wire::kTicksPerTurn) return false;
      }
    }
  }
  return true;
}

}  // namespace lilo
