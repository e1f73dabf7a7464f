// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <nlohmann/json_fwd.hpp>

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lilo {

/// Where a lilod takes requests.
struct LilodAddress {
  std::string host = "127.0.0.1";  ///< a name or an address
  std::uint16_t port = 9871;
};

/// "host:port", for messages.
std::string to_string(const LilodAddress& address);

/// What a subscriber is sent: poses and health, or with them the sensor's packets.
enum class Subscription : std::uint8_t { messages, with_packets };

/// A conversation with one lilod on this or another host by daemon/PROTOCOL.md: shows the token it
/// is asked for, keeps the lease, ends it when it goes. One thread. Throws std::runtime_error, one
/// line that names the address and the cure.
class Connection {
 public:
  using Milliseconds = std::chrono::milliseconds;

  /// How long an answer may take.
  static constexpr Milliseconds kPatience{3000};

  explicit Connection(const LilodAddress& address, Milliseconds patience = kPatience);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// The answer to a request, which is sent once: an object that holds `kind`. What the daemon
  /// refuses is an exception with its reason.
  nlohmann::json ask(const nlohmann::json& request, const std::string& kind,
                     Milliseconds patience = kPatience);

  /// From now on all of it comes, as long as receive() is called once a second. Throws when the
  /// daemon gives us no packets.
  void subscribe(Subscription what = Subscription::messages);
  /// The next datagram that is no answer, or nothing when none came in time, a
  /// signal came or `or_readable` (a file descriptor; -1: none) had something to read. It lives
  /// until the next call. Throws when the daemon gives us no packets any more.
  std::optional<std::string_view> receive(Milliseconds at_most, int or_readable = -1);

  /// Name and version of the daemon, as it said when the conversation began.
  [[nodiscard]] const std::string& software() const { return software_; }
  [[nodiscard]] const LilodAddress& address() const { return address_; }

 private:
  using Clock = std::chrono::steady_clock;

  void connect();
  void greet(Milliseconds patience);
  void renew();
  void send(nlohmann::json request);
  enum class Waited : std::uint8_t { datagram, in_vain, other };
  Waited wait(Clock::time_point until, int or_readable);
  std::optional<std::string_view> take();
  [[nodiscard]] nlohmann::json understood(std::string_view datagram);
  void await_packets();
  [[nodiscard]] bool has_packets(const nlohmann::json& message) const;
  [[nodiscard]] std::string no_answer(Milliseconds patience) const;

  LilodAddress address_;
  boost::asio::io_context io_;
  boost::asio::ip::udp::socket socket_;
  std::string token_, software_;
  bool refused_ = false;  // the host said that nobody listens there
  Subscription subscription_ = Subscription::messages;
  std::optional<Clock::time_point> renew_at_;
  std::array<char, 65536> buffer_{};
};

}  // namespace lilo
