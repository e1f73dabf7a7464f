// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/packet_source.hpp"
#include "tools/replay/pacer.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>

#include <cstdint>
#include <functional>
#include <string>

namespace lilo {

struct ReplayOptions {
  std::string host = "127.0.0.1";
  double speed = 1.0;
  std::uint16_t data_port = 0;      ///< where all others go; 0: as in the capture
  std::uint16_t position_port = 0;  ///< where packets to port 8308 go; 0: as in the capture
};

struct ReplayCounts {
  std::uint64_t packets = 0;
  std::uint64_t bytes = 0;      ///< UDP payload
  std::int64_t latest_ns = 0;   ///< how late the latest packet left
  std::int64_t elapsed_ns = 0;  ///< since the first packet was due
};

/// Sends the payloads of a capture as UDP datagrams when they are due. One thread.
class Player {
 public:
  /// Throws std::runtime_error when the host cannot be resolved.
  explicit Player(const ReplayOptions& options);

  /// Plays the source to its end, or until `go_on` says false; it is asked before every packet and
  /// every tenth of a second while waiting. Returns whether the end was reached. Throws
  /// std::runtime_error when the system refuses to send.
  bool play(PacketSource& source, const std::function<bool(const ReplayCounts&)>& go_on);

  [[nodiscard]] const ReplayCounts& counts() const { return counts_; }

 private:
  bool wait_until(std::int64_t due_ns, const std::function<bool(const ReplayCounts&)>& go_on);
  void send(const PacketView& packet);
  [[nodiscard]] std::uint16_t port_for(const PacketView& packet) const;

  ReplayOptions options_;
  boost::asio::io_context io_;
  boost::asio::ip::udp::endpoint destination_;
  boost::asio::ip::udp::socket socket_;
  std::int64_t start_ns_;
  Pacer pacer_;
  ReplayCounts counts_;
};

}  // namespace lilo
