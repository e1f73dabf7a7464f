#pragma once

#include "tools/connection/connection.hpp"
#include "tools/pcap/pcap_writer.hpp"
#include "tools/record/tapped_packet.hpp"

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>

namespace lilo {

/// The sensor's packets as lilod got them, by a subscription of their own, into a pcap file with
/// lilod's receive times: no root, nothing taken from the daemon. On a thread of its own.
class PacketRecorder {
 public:
  /// Throws std::runtime_error.
  PacketRecorder(const LilodAddress& address, const std::string& path);
  ~PacketRecorder();
  PacketRecorder(const PacketRecorder&) = delete;
  PacketRecorder& operator=(const PacketRecorder&) = delete;

  /// Ends the thread and the file. Throws what went wrong meanwhile, std::runtime_error.
  void finish();

  [[nodiscard]] std::uint64_t packets() const { return packets_; }
  /// That lilod passed on and we did not get.
  [[nodiscard]] std::uint64_t missed() const { return missed_; }

 private:
  void run();
  void take(const NumberedPacket& numbered);

  Connection lilod_;
  PcapWriter file_;
  std::atomic<bool> stop_{false};
  std::atomic<std::uint64_t> packets_{0}, missed_{0};
  std::optional<std::uint32_t> next_number_;
  std::string failure_;
  std::thread thread_;
};

}  // namespace lilo
