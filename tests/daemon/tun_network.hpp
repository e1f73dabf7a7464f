// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lilo {

/// A network of this process's own: 127.0.0.1 and 10.77.0.1 are this computer, and all other
/// addresses of 10.77.0.0/16 are the test, which writes and reads their packets itself. So it can
/// send with any sender's address, and sees all that goes to any of them.
class TunNetwork {
 public:
  struct Endpoint {
    std::uint32_t ipv4 = 0;
    std::uint16_t port = 0;
    // NOLINTNEXTLINE(modernize-use-nullptr): what clang makes of it compares with 0
    auto operator<=>(const Endpoint&) const = default;
  };
  struct Datagram {
    Endpoint to;
    std::string payload;
  };

  /// Takes the process out of the computer's network for good, so it needs a single thread and
  /// root's or a user namespace's rights. Throws std::system_error when the system refuses.
  TunNetwork();
  ~TunNetwork();
  TunNetwork(const TunNetwork&) = delete;
  TunNetwork& operator=(const TunNetwork&) = delete;

  /// 10.77.third.fourth
  static Endpoint host(unsigned third, unsigned fourth, std::uint16_t port);

  /// To 10.77.0.1. At most 1400 bytes.
  void send(const Endpoint& from, std::uint16_t to_port, std::string_view payload) const;
  /// The next UDP datagram that this computer sent to one of the others.
  [[nodiscard]] std::optional<Datagram> receive(std::chrono::milliseconds at_most) const;

 private:
  int fd_;
};

}  // namespace lilo
