// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/pcap/pcap_writer.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lilo {

/// The sensor's packets as a daemon passes them on, into a pcap file with stamps in nanoseconds.
/// The daemon does not see Ethernet and the IPv4 header: those are a Velodyne's, with a broadcast
/// as the destination. One thread.
class PacketRecording {
 public:
  /// Throws std::runtime_error when the file cannot be made.
  explicit PacketRecording(const std::string& path);

  /// A datagram for which is_packet() holds; one that is broken is left out.
  void take(std::string_view datagram);
  /// Throws std::runtime_error when not everything reached the file.
  void finish() { file_.close(); }

  [[nodiscard]] std::uint64_t packets() const { return packets_; }
  /// Packets between the first and the last one that did not come, by their numbers.
  [[nodiscard]] std::uint64_t missed() const { return missed_; }

 private:
  void count(std::uint64_t seq);

  PcapWriter file_;
  std::uint64_t packets_ = 0, missed_ = 0;
  std::optional<std::uint64_t> next_seq_;  // none: no packet yet
};

/// "7540 packets, none missed", or how many and what helps.
std::string to_text(const PacketRecording& packets);

}  // namespace lilo
