// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/daemon_link.hpp"

#include <boost/asio/buffer.hpp>
#include <fmt/format.h>

#include <stdexcept>
#include <utility>

namespace lilo::view {
namespace {

using boost::asio::ip::udp;
using boost::system::error_code;
using nlohmann::json;

// Padded to this, all answers to a request without a token fit into it (PROTOCOL.md).
constexpr std::size_t kRequestBytes = 256;
constexpr auto kRenewal = std::chrono::seconds(1);
constexpr double kLease_s = 5.0;
constexpr int kReceiveBuffer = 4 << 20;  // bytes: points come in bursts

udp::endpoint resolve(boost::asio::io_context& io, const std::string& host, std::uint16_t port) {
  error_code error;
  const auto found = udp::resolver(io).resolve(udp::v4(), host, std::to_string(port), error);
  if (error || found.empty())
    throw std::runtime_error(
        fmt::format("{}: expected a host, found none: {}", host, error.message()));
  return *found.begin();
}

}  // namespace

DaemonLink::DaemonLink(boost::asio::io_context& io, const std::string& host, std::uint16_t port,
                       std::function<void(std::string_view)> take)
    : socket_(io, udp::v4()), renewal_(io), take_(std::move(take)) {
  error_code ignored;  // the kernel grants no more than net.core.rmem_max
  socket_.set_option(boost::asio::socket_base::receive_buffer_size(kReceiveBuffer), ignored);
  socket_.connect(resolve(io, host, port));  // so that only the daemon's datagrams come in
  receive();
  renew();
}

void DaemonLink::request(json body) {
  if (!token_.empty()) body["token"] = token_;
  std::string text = body.dump();
  if (text.size() < kRequestBytes) text.resize(kRequestBytes, ' ');
  error_code ignored;  // nobody listens yet: the lease is asked for again
  socket_.send(boost::asio::buffer(text), 0, ignored);
}

double DaemonLink::silent_s() const {
  if (last_ == std::chrono::steady_clock::time_point{}) return 1e9;
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - last_).count();
}

void DaemonLink::renew() {
  request({{"subscribe", {{"ttl_s", kLease_s}, {"points", true}}}});
  renewal_.expires_after(kRenewal);
  renewal_.async_wait([this](const error_code& error) {
    if (!error) renew();
  });
}

void DaemonLink::receive() {
  socket_.async_receive(boost::asio::buffer(buffer_),
                        [this](const error_code& error, std::size_t size) {
                          if (error == boost::asio::error::operation_aborted) return;
                          if (!error) {
                            last_ = std::chrono::steady_clock::now();
                            const std::string_view datagram(buffer_.data(), size);
                            if (datagram.find("\"hello\"") != std::string_view::npos)
                              take_hello(datagram);
                            take_(datagram);
                          }
                          receive();
                        });
}

void DaemonLink::take_hello(std::string_view datagram) {
  const json message = json::parse(datagram, nullptr, /*allow_exceptions=*/false);
  if (!message.is_object() || !message.contains("hello")) return;
  const json& hello = message["hello"];
  if (hello.contains("token") && hello["token"].is_string()) {
    const auto token = hello["token"].get<std::string>();
    const bool is_new = token != token_;
    token_ = token;
    if (is_new) renew();
    return;
  }
  answered_ = true;
  has_points_ = hello.contains("points");
}

}  // namespace lilo::view
