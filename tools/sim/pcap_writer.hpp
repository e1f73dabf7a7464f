#pragma once

#include "tools/sim/packet.hpp"

#include <memory>
#include <string>

namespace lilo::sim {

/// Writes UDP payloads as a sensor broadcasts them, in Ethernet and IPv4, to a classic pcap file.
class PcapWriter {
 public:
  /// Throws std::runtime_error when the file cannot be made.
  PcapWriter(const std::string& path, bool nanoseconds);
  ~PcapWriter();
  PcapWriter(const PcapWriter&) = delete;
  PcapWriter& operator=(const PcapWriter&) = delete;

  void write(const Packet& packet, std::int64_t received_utc_ns);
  /// Throws std::runtime_error when not everything reached the file.
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lilo::sim
