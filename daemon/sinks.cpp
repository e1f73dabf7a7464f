// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sinks.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/address_v4.hpp>

#include <charconv>
#include <stdexcept>

namespace lilo {

namespace ip = boost::asio::ip;

ip::udp::endpoint parse_endpoint(const std::string& text) {
  const auto refuse = [&] {
    throw std::invalid_argument("expected HOST:PORT with an IPv4 address or localhost, found " +
                                text);
  };
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) refuse();
  std::uint16_t port = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, failure] = std::from_chars(text.data() + colon + 1, end, port);
  const std::string host = text.substr(0, colon);
  boost::system::error_code error;
  const auto address = ip::make_address_v4(host == "localhost" ? "127.0.0.1" : host, error);
  if (error || failure != std::errc{} || stopped != end || port == 0) refuse();
  return {address, port};
}

Sinks::Sinks(boost::asio::io_context& io) : socket_(io, ip::udp::v4()) {
  socket_.non_blocking(true);
}

void Sinks::set(const std::vector<std::string>& endpoints) {
  std::vector<ip::udp::endpoint> parsed;
  parsed.reserve(endpoints.size());
  for (const std::string& text : endpoints) parsed.push_back(parse_endpoint(text));
  endpoints_ = std::move(parsed);
}

void Sinks::send(std::string_view datagram) {
  for (const ip::udp::endpoint& endpoint : endpoints_) {
    boost::system::error_code error;
    socket_.send_to(boost::asio::buffer(datagram.data(), datagram.size()), endpoint, 0, error);
    if (error) ++send_errors_;
  }
}

}  // namespace lilo
