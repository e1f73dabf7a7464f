// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/packet_message.hpp"

#include <algorithm>
#include <cstring>
#include <span>

namespace lilo {
namespace {

constexpr std::string_view kMagic = "LLPK";
constexpr std::uint8_t kVersion = 1;

// Where the fields are, in network byte order.
constexpr std::size_t kVersionAt = 4, kLengthAt = 6, kSeqAt = 8, kStampAt = 16, kAddressAt = 24,
                      kSourcePortAt = 28, kDestinationPortAt = 30;

template <typename Unsigned>
void put(char* at, Unsigned value) {
  for (std::size_t k = sizeof(Unsigned); k-- > 0;) {
    at[k] = static_cast<char>(value & 0xffU);
    value = static_cast<Unsigned>(value >> 8U);
  }
}

template <typename Unsigned>
Unsigned get(const char* at) {
  std::uint64_t value = 0;
  for (std::size_t k = 0; k < sizeof(Unsigned); ++k)
    value = value << 8U | static_cast<std::uint8_t>(at[k]);
  return static_cast<Unsigned>(value);
}

}  // namespace

void write_packet(std::uint64_t seq, const PacketView& packet, PacketDatagram& out) {
  const std::size_t length = std::min(packet.payload.size(), kMostPacketBytes);
  char* const bytes = out.bytes.data();
  std::memcpy(bytes, kMagic.data(), kMagic.size());
  put<std::uint16_t>(bytes + kVersionAt, kVersion << 8U);  // and no flag
  put<std::uint16_t>(bytes + kLengthAt, static_cast<std::uint16_t>(length));
  put<std::uint64_t>(bytes + kSeqAt, seq);
  put<std::uint64_t>(bytes + kStampAt, static_cast<std::uint64_t>(packet.received_ns));
  put<std::uint32_t>(bytes + kAddressAt, packet.source_ipv4);
  put<std::uint16_t>(bytes + kSourcePortAt, packet.source_port);
  put<std::uint16_t>(bytes + kDestinationPortAt, packet.destination_port);
  if (length > 0) std::memcpy(bytes + kPacketHeaderBytes, packet.payload.data(), length);
  out.size = kPacketHeaderBytes + length;
}

bool is_packet(std::string_view datagram) { return datagram.starts_with(kMagic); }

std::optional<PacketMessage> read_packet(std::string_view datagram) {
  if (!is_packet(datagram) || datagram.size() < kPacketHeaderBytes) return std::nullopt;
  const char* const bytes = datagram.data();
  const auto length = get<std::uint16_t>(bytes + kLengthAt);
  if (get<std::uint8_t>(bytes + kVersionAt) != kVersion) return std::nullopt;
  if (datagram.size() != kPacketHeaderBytes + length) return std::nullopt;
  PacketMessage out{.seq = get<std::uint64_t>(bytes + kSeqAt), .packet = {}};
  out.packet.received_ns = static_cast<std::int64_t>(get<std::uint64_t>(bytes + kStampAt));
  out.packet.source_ipv4 = get<std::uint32_t>(bytes + kAddressAt);
  out.packet.source_port = get<std::uint16_t>(bytes + kSourcePortAt);
  out.packet.destination_port = get<std::uint16_t>(bytes + kDestinationPortAt);
  out.packet.payload = std::as_bytes(std::span(bytes + kPacketHeaderBytes, length));
  return out;
}

}  // namespace lilo
