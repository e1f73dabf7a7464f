// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/position_packet.hpp"

#include "drivers/wire.hpp"

#include <algorithm>
#include <array>

namespace lilo {
namespace {

constexpr std::size_t kStampAt = 0xC6, kPpsAt = 0xCA, kNmeaAt = 0xCE, kNmeaBytes = 128;
constexpr std::uint8_t kPpsLocked = 2;

}  // namespace

std::optional<PositionPacket> parse_position_packet(std::span<const std::byte> payload) {
  if (payload.size() != wire::kPositionPacketBytes) return std::nullopt;
  PositionPacket packet;
  packet.stamp_us = wire::u32(payload.data() + kStampAt);
  if (packet.stamp_us > wire::kMaxStampUs) return std::nullopt;
  packet.pps_locked = wire::u8(payload.data() + kPpsAt) == kPpsLocked;
  std::array<char, kNmeaBytes> sentence;
  std::transform(payload.begin() + kNmeaAt, payload.begin() + kNmeaAt + kNmeaBytes,
                 sentence.begin(), [](std::byte b) { return static_cast<char>(b); });
  packet.gps = parse_gprmc({sentence.data(), sentence.size()});
  return packet;
}

}  // namespace lilo
