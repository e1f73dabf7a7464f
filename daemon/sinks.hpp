// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lilo {

/// "HOST:PORT" as the configuration has it (an IPv4 address or localhost) as an endpoint. Throws
/// std::invalid_argument for anything else.
boost::asio::ip::udp::endpoint parse_endpoint(const std::string& text);

/// The fixed receivers of every datagram. One thread.
class Sinks {
 public:
  explicit Sinks(boost::asio::io_context& io);

  void set(const std::vector<std::string>& endpoints);
  /// Never waits: what the socket does not take at once is counted and gone.
  void send(std::string_view datagram);

  [[nodiscard]] std::uint64_t send_errors() const { return send_errors_; }

 private:
  boost::asio::ip::udp::socket socket_;
  std::vector<boost::asio::ip::udp::endpoint> endpoints_;
  std::uint64_t send_errors_ = 0;
};

}  // namespace lilo
