// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/ip/address.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace lilo {

/// IPv4 in IPv6 (::ffff:10.0.0.1) as the IPv4 address it stands for: what a socket of both families
/// says of an IPv4 client.
boost::asio::ip::address unmapped(const boost::asio::ip::address& address);

/// Addresses and CIDR ranges, IPv4 and IPv6: "10.0.0.7", "192.168.1.0/24", "fd00::/8".
class AllowList {
 public:
  /// Throws std::invalid_argument when a text is none of these.
  explicit AllowList(const std::vector<std::string>& ranges);

  [[nodiscard]] bool contains(const boost::asio::ip::address& address) const;

 private:
  struct Range {
    bool v4 = true;
    std::array<std::uint8_t, 16> bytes{};  // of an IPv4 address the first four
    unsigned bits = 0;                     // that have to be equal
  };
  static Range parse(const std::string& text);
  static Range single(const boost::asio::ip::address& address);

  std::vector<Range> ranges_;
};

}  // namespace lilo
