// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace lilo {

using SipKey = std::array<std::uint64_t, 2>;

/// SipHash-2-4 (Aumasson and Bernstein, 2012): a keyed hash whose value nobody guesses without the
/// key. Ours because no library of the package list has it.
std::uint64_t siphash(const SipKey& key, std::span<const std::byte> bytes);

/// Who asks: an IPv6 address, or an IPv4 one mapped into it, and a port.
struct Requester {
  std::array<std::uint8_t, 16> address{};
  std::uint16_t port = 0;
};

/// Tokens that prove a client receives what is sent to its address, without a table that strangers
/// could fill: a token is a hash of address, port and time.
class TokenMaker {
 public:
  TokenMaker();  ///< a key of its own, from the system's random source

  /// Sixteen hexadecimal digits, good for 30 to 60 s.
  [[nodiscard]] std::string make(const Requester& who, std::int64_t now_ns) const;
  [[nodiscard]] bool accept(std::string_view token, const Requester& who,
                            std::int64_t now_ns) const;

 private:
  [[nodiscard]] std::string of_period(const Requester& who, std::int64_t period) const;
  SipKey key_;
};

}  // namespace lilo
