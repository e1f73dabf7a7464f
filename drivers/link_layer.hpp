// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace lilo {

/// A UDP datagram found in a captured frame. `payload` points into the frame.
struct Datagram {
  std::uint32_t source_ipv4 = 0;  ///< host byte order
  std::uint16_t source_port = 0;
  std::uint16_t destination_port = 0;
  std::span<const std::byte> payload;
};

enum class FrameKind : std::uint8_t {
  udp,
  foreign,    ///< anything that is not UDP over IPv4
  fragment,   ///< a piece of an IPv4 datagram
  truncated,  ///< the capture holds less than the headers say
};

struct Frame {
  FrameKind kind = FrameKind::foreign;
  Datagram datagram;  ///< set where kind is udp
};

/// Whether parse_frame() knows how frames of this libpcap link type (DLT_*) begin: Ethernet, Linux
/// cooked v1 and v2, raw IP, BSD loopback.
bool is_known_link_type(int link_type);

/// Walks the layers of one captured frame. Ethernet with any number of VLAN tags (802.1Q, 802.1ad),
/// IPv4 with options. `frame` is what was captured, never what the wire carried.
Frame parse_frame(int link_type, std::span<const std::byte> frame);

}  // namespace lilo
