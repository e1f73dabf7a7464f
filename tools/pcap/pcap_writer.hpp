// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace lilo {

/// Who sent a datagram to whom; addresses in host byte order.
struct UdpAddresses {
  std::uint32_t source_ipv4 = 0, destination_ipv4 = 0;
  std::uint16_t source_port = 0, destination_port = 0;
};

/// Writes UDP payloads in Ethernet and IPv4 to a classic pcap file.
class PcapWriter {
 public:
  /// Throws std::runtime_error when the file cannot be made.
  PcapWriter(const std::string& path, bool nanoseconds);
  ~PcapWriter();
  PcapWriter(const PcapWriter&) = delete;
  PcapWriter& operator=(const PcapWriter&) = delete;

  void write(const UdpAddresses& addresses, std::span<const std::byte> payload,
             std::int64_t received_utc_ns);
  /// Throws std::runtime_error when not everything reached the file.
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lilo
