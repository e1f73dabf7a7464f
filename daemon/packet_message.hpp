// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/packet_source.hpp"
#include "drivers/spsc_ring.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

/// A packet of the sensor as a datagram for clients that record: the 32 bytes of PROTOCOL.md, and
/// the packet. Free functions, any thread.
namespace lilo {

inline constexpr std::size_t kPacketHeaderBytes = 32;
/// Longest packet that is sent, a Velodyne's data packet. What is longer is no sensor's.
inline constexpr std::size_t kMostPacketBytes = 1206;

/// The datagram with one packet.
struct PacketDatagram {
  std::array<char, kPacketHeaderBytes + kMostPacketBytes> bytes{};
  std::size_t size = 0;  ///< bytes

  [[nodiscard]] std::string_view view() const { return {bytes.data(), size}; }
};

/// Receiver to publisher, while a client has asked for packets.
using PacketRing = SpscRing<PacketDatagram>;

/// What such a datagram holds; `packet` views it.
struct PacketMessage {
  std::uint64_t seq = 0;  ///< packets the daemon received before this one since its start
  PacketView packet;
};

/// The packet is at most kMostPacketBytes long. No allocation.
void write_packet(std::uint64_t seq, const PacketView& packet, PacketDatagram& out);

/// Tells such a datagram from JSON.
bool is_packet(std::string_view datagram);
/// Nothing when it is none, is cut, or is of a version that we do not know.
std::optional<PacketMessage> read_packet(std::string_view datagram);

}  // namespace lilo
