// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <netinet/in.h>
#include <optional>
#include <string>

namespace lilo {

/// A loopback UDP socket on a port of the system's choice, for tests.
class UdpSocket {
 public:
  UdpSocket();
  ~UdpSocket();
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::string endpoint() const { return "127.0.0.1:" + std::to_string(port_); }
  std::optional<std::string> receive(std::chrono::milliseconds at_most);
  /// Port that the datagram received last came from.
  [[nodiscard]] std::uint16_t sender() const { return sender_; }
  void send_to(std::uint16_t port, const std::string& datagram) const;

 private:
  int fd_;
  std::uint16_t port_ = 0, sender_ = 0;
};

/// A port that was free a moment ago, and that no socket which asks for any port gets.
std::uint16_t free_udp_port();

/// An address of this computer that is not loopback, or nothing.
std::optional<std::string> outer_address();

/// What systemd would hear: the socket that NOTIFY_SOCKET names.
class NotifySocket {
 public:
  NotifySocket();
  ~NotifySocket();
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  /// Reads on until a message holds `text` at the start of a line. Everything read stays in log().
  bool wait_for(const std::string& text, std::chrono::milliseconds at_most);
  [[nodiscard]] const std::string& log() const { return log_; }

 private:
  std::string path_;
  int fd_;
  std::string log_;
};

}  // namespace lilo
