// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/pcap/pcap_writer.hpp"
#include "tools/sim/packet.hpp"

namespace lilo::sim {

/// As a sensor at its factory address broadcasts it.
inline UdpAddresses addresses_of(const Packet& packet) {
  return {.source_ipv4 = 0xC0A801C9,  // 192.168.1.201
          .destination_ipv4 = 0xFFFFFFFF,
          .source_port = packet.port,
          .destination_port = packet.port};
}

}  // namespace lilo::sim
