// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/config.hpp"
#include "daemon/allow_list.hpp"
#include "daemon/answer_writer.hpp"
#include "daemon/client_table.hpp"
#include "daemon/request.hpp"
#include "daemon/saver.hpp"
#include "daemon/token.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace lilo {

/// What the server asks of the daemon. Datagrams live until the next call.
struct ServerActions {
  std::function<std::string_view()> last_pose;            ///< empty: none yet
  std::function<std::string_view()> health;               ///< as of now
  std::function<bool(const std::optional<Pose>&)> reset;  ///< false: one is under way
  /// Answers later, or at once when it cannot be.
  std::function<void(SaveKind, SaveDone)> save;
  std::function<const std::string&()> session;
  std::function<void()> packets_asked;  ///< somebody was granted packets, or still has them
};

/// The side of the protocol that listens: subscriptions, queries, resets, saving. One thread.
///
/// Nobody can turn it against a third party: it answers loopback, and addresses of the allow-list;
/// those first have to send back a token that only their real owner received, and until then get no
/// more bytes than they sent. The clients, and the answers in a second, are bounded; who has shown
/// no token cannot use up the answers of those who have, and nobody the leases of subscribers.
class Server {
 public:
  /// Does nothing when config.port is 0. Throws std::runtime_error when it cannot be bound.
  Server(boost::asio::io_context& io, const SubscribeConfig& config, const PublishConfig& publish,
         ServerActions actions);

  /// Leases and the allow-list may change while it runs.
  void configure(const SubscribeConfig& config);
  /// To all subscribers.
  void send(std::string_view datagram);
  /// To those that have subscribed to points.
  void send_points(std::string_view datagram);
  /// To those that have subscribed to packets. Never takes the socket's last room, which is for
  /// poses: a packet for which there is no more than that is counted and left out.
  void send_packet(std::string_view datagram);
  /// Once a second: ends leases, allows new answers.
  void tick();

  [[nodiscard]] std::size_t clients() const { return clients_.clients().size(); }
  [[nodiscard]] bool has_points_clients() const { return clients_.points_clients() > 0; }
  [[nodiscard]] bool has_packets_clients() const { return clients_.packets_clients() > 0; }
  /// Packets to a subscriber that were sent, and those for which there was no room.
  [[nodiscard]] std::uint64_t packets_sent() const { return packets_sent_; }
  [[nodiscard]] std::uint64_t packets_not_sent() const { return packets_not_sent_; }
  /// Subscriptions for which there was no room.
  [[nodiscard]] std::uint64_t clients_refused() const { return clients_refused_; }
  [[nodiscard]] std::uint64_t send_errors() const { return send_errors_; }

 private:
  using Endpoint = boost::asio::ip::udp::endpoint;

  void listen();
  void await_request();
  void handle(std::string_view datagram);
  void serve(const Request& request);
  void subscribe(const Request& request);
  [[nodiscard]] PacketsAnswer answer_packets(bool wanted, bool has) const;
  [[nodiscard]] bool has_room_for_packets();
  void answer_query(const std::string& query);
  [[nodiscard]] bool is_known(const Endpoint& from) const;
  [[nodiscard]] bool is_proven(const ParsedRequest& parsed) const;
  [[nodiscard]] bool may_be_served(const Request& request) const;
  void answer(std::string_view datagram) { answer(datagram, from_); }
  void answer(std::string_view datagram, const Endpoint& to);
  void answer_unproven(std::string_view datagram);
  bool send_to(std::string_view datagram, const Endpoint& to);

  boost::asio::ip::udp::socket socket_;
  SubscribeConfig config_;
  AllowList allow_;
  AnswerWriter writer_;
  ServerActions actions_;
  ClientTable clients_;
  TokenMaker tokens_;
  Endpoint from_;
  std::array<char, kMaxRequestBytes + 1> buffer_{};  // one more byte tells an oversized request
  std::size_t request_bytes_ = 0;
  int answers_left_ = 0, answers_to_unproven_left_ = 0;  // this second
  int send_buffer_bytes_ = 0;
  std::uint64_t packets_sent_ = 0, packets_not_sent_ = 0;
  std::uint64_t clients_refused_ = 0, send_errors_ = 0;
};

}  // namespace lilo
