// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <nlohmann/json.hpp>

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace lilo::view {

/// A subscription to a lilod, points and all, that outlives its restarts: a client of the protocol
/// like any other.
class DaemonLink {
 public:
  /// `take`: every datagram that came. Throws std::runtime_error when the host has no address.
  DaemonLink(boost::asio::io_context& io, const std::string& host, std::uint16_t port,
             std::function<void(std::string_view)> take);

  /// Sends a request besides the subscription.
  void request(nlohmann::json body);

  /// Since the last datagram; very long before the first.
  [[nodiscard]] double silent_s() const;
  /// Whether the last answer to the subscription granted points.
  [[nodiscard]] bool has_points() const { return has_points_; }
  [[nodiscard]] bool was_answered() const { return answered_; }

 private:
  void receive();
  void renew();
  void take_hello(std::string_view datagram);

  boost::asio::ip::udp::socket socket_;
  boost::asio::steady_timer renewal_;
  std::function<void(std::string_view)> take_;
  std::array<char, 2048> buffer_{};
  std::string token_;
  bool answered_ = false, has_points_ = false;
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace lilo::view
