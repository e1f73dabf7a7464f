#pragma once

#include "config/config.hpp"
#include "daemon/client_table.hpp"
#include "daemon/json_writer.hpp"
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
};

/// The side of the protocol that listens: subscriptions, queries, resets, saving. One thread.
///
/// Nobody can turn it against a third party: it answers loopback, and addresses of the allow-list;
/// those first have to send back a token that only their real owner received. The clients, and the
/// answers in a second, are bounded.
class Server {
 public:
  /// Does nothing when config.port is 0. Throws std::runtime_error when it cannot be bound.
  Server(boost::asio::io_context& io, const SubscribeConfig& config, const PublishConfig& publish,
         ServerActions actions);

  /// Leases and the allow-list may change while it runs.
  void configure(const SubscribeConfig& config) { config_ = config; }
  /// To all subscribers.
  void send(std::string_view datagram);
  /// Once a second: ends leases, allows new answers.
  void tick();

  [[nodiscard]] std::size_t clients() const { return clients_.clients().size(); }
  [[nodiscard]] std::uint64_t requests_refused() const { return requests_refused_; }
  [[nodiscard]] std::uint64_t send_errors() const { return send_errors_; }

 private:
  using Endpoint = boost::asio::ip::udp::endpoint;

  void await_request();
  void handle(std::string_view datagram);
  void serve(const Request& request);
  void answer_query(const std::string& query);
  void say_saved(const SaveResult& result, const Endpoint& to);
  [[nodiscard]] bool is_known(const Endpoint& from) const;
  [[nodiscard]] bool is_proven(const Request& request) const;
  void say_hello(double ttl_s, bool with_token);
  void say_error(std::string_view why) { say_error(why, from_); }
  void say_error(std::string_view why, const Endpoint& to);
  void begin(JsonWriter& out);
  void answer(std::string_view datagram) { answer(datagram, from_); }
  void answer(std::string_view datagram, const Endpoint& to);
  void send_to(std::string_view datagram, const Endpoint& to);

  boost::asio::ip::udp::socket socket_;
  SubscribeConfig config_;
  PublishConfig publish_;
  ServerActions actions_;
  ClientTable clients_;
  TokenMaker tokens_;
  Endpoint from_;
  std::array<char, kMaxRequestBytes + 1> buffer_{};  // one more byte tells an oversized request
  JsonWriter json_;
  int answers_left_ = 0;
  std::uint64_t requests_refused_ = 0, send_errors_ = 0;
};

}  // namespace lilo
