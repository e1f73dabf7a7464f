// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/drivers/packets.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace lilo::test {

using Buffer = std::vector<std::byte>;

/// Frames around a UDP payload, written from the RFCs (768, 791) and libpcap's link-type pages.
Buffer udp_datagram(const Buffer& payload, std::uint16_t port = 2368);
Buffer ipv4(const Buffer& datagram, int option_bytes = 0, std::uint16_t fragment = 0,
            int protocol = 17);
Buffer ethernet(const Buffer& ip, const std::vector<std::uint16_t>& vlan_tags = {},
                std::uint16_t type = 0x0800);
Buffer cooked(const Buffer& ip);
Buffer cooked2(const Buffer& ip);

struct CaptureFormat {
  int link_type = 1;
  bool nanoseconds = false;
  bool big_endian = false;
};
struct Record {
  Buffer frame;
  std::int64_t time_ns = 0;
  std::size_t captured = SIZE_MAX;  ///< at most the frame
};

/// The bytes of a classic pcap file.
std::string pcap_bytes(const std::vector<Record>& records, const CaptureFormat& format = {});
/// The bytes of a pcapng file of the same.
std::string pcapng_bytes(const std::vector<Record>& records);

/// Each packet as Ethernet, at the time it was received.
std::vector<Record> records_of(const std::vector<TimedPacket>& packets);

/// Writes to a file of this name in a folder of the running test and says where that is.
std::string write_file(const std::string& name, const std::string& bytes);

}  // namespace lilo::test
