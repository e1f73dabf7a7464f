// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/link_layer.hpp"

#include <pcap/dlt.h>

namespace lilo {
namespace {

using Bytes = std::span<const std::byte>;

constexpr std::uint16_t kEtherIpv4 = 0x0800;
constexpr std::uint16_t kEtherVlan = 0x8100, kEtherServiceVlan = 0x88A8, kEtherOldVlan = 0x9100;
constexpr std::uint8_t kProtocolUdp = 17;
constexpr std::size_t kIpMinBytes = 20, kUdpHeaderBytes = 8;
constexpr int kLinkTypeRaw = 101;  // DLT_RAW differs between systems; files hold 101 or 12
constexpr int kLinkTypeIpv4 = 228;

std::uint8_t u8(Bytes b, std::size_t at) { return std::to_integer<std::uint8_t>(b[at]); }
std::uint16_t be16(Bytes b, std::size_t at) {
  return static_cast<std::uint16_t>((u8(b, at) << 8) | u8(b, at + 1));
}
std::uint32_t be32(Bytes b, std::size_t at) {
  return (static_cast<std::uint32_t>(be16(b, at)) << 16) | be16(b, at + 2);
}

Frame parse_ipv4(Bytes ip) {
  if (ip.size() < kIpMinBytes) return {FrameKind::truncated, {}};
  const std::size_t header_bytes = static_cast<std::size_t>(u8(ip, 0) & 0x0FU) * 4;
  if (u8(ip, 0) >> 4 != 4 || header_bytes < kIpMinBytes) return {};
  if (u8(ip, 9) != kProtocolUdp) return {};
  constexpr std::uint16_t kMoreFragments = 0x2000, kOffsetMask = 0x1FFF;
  if ((be16(ip, 6) & (kMoreFragments | kOffsetMask)) != 0) return {FrameKind::fragment, {}};
  if (ip.size() < header_bytes + kUdpHeaderBytes) return {FrameKind::truncated, {}};
  const Bytes udp = ip.subspan(header_bytes);
  const std::size_t udp_bytes = be16(udp, 4);
  if (udp_bytes < kUdpHeaderBytes) return {};
  if (udp.size() < udp_bytes) return {FrameKind::truncated, {}};
  return {FrameKind::udp,
          {.source_ipv4 = be32(ip, 12),
           .source_port = be16(udp, 0),
           .destination_port = be16(udp, 2),
           .payload = udp.subspan(kUdpHeaderBytes, udp_bytes - kUdpHeaderBytes)}};
}

// `at`: where the type field is; what follows it is the next layer.
Frame parse_ether_type(Bytes frame, std::size_t at) {
  while (true) {
    if (frame.size() < at + 2) return {FrameKind::truncated, {}};
    const std::uint16_t type = be16(frame, at);
    at += 2;
    if (type == kEtherIpv4) return parse_ipv4(frame.subspan(at));
    if (type != kEtherVlan && type != kEtherServiceVlan && type != kEtherOldVlan) return {};
    at += 2;  // the tag's priority and identifier; the type of what it wraps follows
  }
}

// Linux cooked v2: the type comes first, the header is 20 bytes.
Frame parse_cooked2(Bytes frame) {
  constexpr std::size_t kHeaderBytes = 20;
  if (frame.size() < kHeaderBytes) return {FrameKind::truncated, {}};
  const std::uint16_t type = be16(frame, 0);
  if (type == kEtherIpv4) return parse_ipv4(frame.subspan(kHeaderBytes));
  if (type != kEtherVlan && type != kEtherServiceVlan) return {};
  return parse_ether_type(frame, kHeaderBytes + 2);
}

// BSD loopback: a four-byte address family in the byte order of the capturing computer.
Frame parse_loopback(Bytes frame) {
  constexpr std::size_t kHeaderBytes = 4;
  if (frame.size() < kHeaderBytes) return {FrameKind::truncated, {}};
  const std::uint32_t family = be32(frame, 0);
  if (family != 2 && family != 0x02000000) return {};
  return parse_ipv4(frame.subspan(kHeaderBytes));
}

}  // namespace

bool is_known_link_type(int link_type) {
  switch (link_type) {
    case DLT_EN10MB:
    case DLT_LINUX_SLL:
    case DLT_LINUX_SLL2:
    case DLT_RAW:
    case kLinkTypeRaw:
    case kLinkTypeIpv4:
    case DLT_NULL:
    case DLT_LOOP:
      return true;
    default:
      return false;
  }
}

Frame parse_frame(int link_type, std::span<const std::byte> frame) {
  constexpr std::size_t kEthernetTypeAt = 12, kCookedTypeAt = 14;
  switch (link_type) {
    case DLT_EN10MB:
      return parse_ether_type(frame, kEthernetTypeAt);
    case DLT_LINUX_SLL:
      return parse_ether_type(frame, kCookedTypeAt);
    case DLT_LINUX_SLL2:
      return parse_cooked2(frame);
    case DLT_RAW:
    case kLinkTypeRaw:
    case kLinkTypeIpv4:
      return parse_ipv4(frame);
    case DLT_NULL:
    case DLT_LOOP:
      return parse_loopback(frame);
    default:
      return {};
  }
}

}  // namespace lilo
