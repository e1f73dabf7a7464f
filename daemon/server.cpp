// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/server.hpp"

#include "daemon/clock.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <fmt/format.h>
#include <linux/sockios.h>

#include <algorithm>
#include <stdexcept>
#include <sys/ioctl.h>
#include <utility>

namespace lilo {
namespace {

namespace ip = boost::asio::ip;
using boost::system::error_code;

constexpr int kAnswersPerSecond = 200, kAnswersToUnprovenPerSecond = 50;
constexpr double kShortestLeaseS = 1.0;

// Whom a token belongs to.
Requester who(const ip::udp::endpoint& from) {
  Requester out{.port = from.port()};
  const ip::address address = from.address();
  out.address = address.is_v6() ? address.to_v6().to_bytes()
                                : ip::make_address_v6(ip::v4_mapped, address.to_v4()).to_bytes();
  return out;
}

std::int64_t to_ns(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

}  // namespace

Server::Server(boost::asio::io_context& io, const SubscribeConfig& config,
               const PublishConfig& publish, ServerActions actions)
    : socket_(io),
      config_(config),
      allow_(config.allow),
      writer_(publish, actions.session),
      actions_(std::move(actions)),
      clients_({.clients = static_cast<std::size_t>(config.max_clients),
                .points = static_cast<std::size_t>(config.points_clients),
                .packets = static_cast<std::size_t>(config.packets_clients)}),
      answers_left_(kAnswersPerSecond),
      answers_to_unproven_left_(kAnswersToUnprovenPerSecond) {
  if (config.port != 0) listen();
}

// An IPv6 socket bound to "::" is for both families.
void Server::listen() {
  const Endpoint local(ip::make_address(config_.bind_address), config_.port);
  error_code error;
  socket_.open(local.protocol(), error);
  if (!error && local.address().is_v6()) socket_.set_option(ip::v6_only(false), error);
  if (!error) socket_.bind(local, error);
  if (error) {
    throw std::runtime_error(fmt::format("subscribe: cannot listen on {} port {}: {}",
                                         config_.bind_address, config_.port, error.message()));
  }
  socket_.non_blocking(true);
  boost::asio::socket_base::send_buffer_size size;
  socket_.get_option(size);
  send_buffer_bytes_ = size.value();
  await_request();
}

void Server::configure(const SubscribeConfig& config) {
  config_ = config;
  allow_ = AllowList(config.allow);
}

void Server::await_request() {
  socket_.async_receive_from(boost::asio::buffer(buffer_), from_,
                             [this](const error_code& error, std::size_t size) {
                               if (error == boost::asio::error::operation_aborted) return;
                               if (!error) handle({buffer_.data(), size});
                               await_request();
                             });
}

bool Server::is_known(const Endpoint& from) const {
  const ip::address address = unmapped(from.address());
  return address.is_loopback() || allow_.contains(address);
}

// That the sender receives what goes to its address: a packet from the loopback network cannot come
// from outside, and others have sent back a token.
bool Server::is_proven(const ParsedRequest& parsed) const {
  if (unmapped(from_.address()).is_loopback()) return true;
  if (!parsed.request) return false;
  return tokens_.accept(parsed.request->token, who(from_), monotonic_ns());
}

void Server::handle(std::string_view datagram) {
  if (!is_known(from_)) return;
  request_bytes_ = datagram.size();
  const ParsedRequest parsed = parse_request(datagram);
  if (!is_proven(parsed)) {
    answer_unproven(parsed.request ? writer_.token(tokens_.make(who(from_), monotonic_ns()))
                                   : writer_.error(parsed.error));
  } else if (!parsed.request) {
    if (answers_left_ > 0) answer(writer_.error(parsed.error));
  } else if (may_be_served(*parsed.request)) {
    serve(*parsed.request);
  }
}

// Subscribers renew even in a second whose answers others have used up.
bool Server::may_be_served(const Request& request) const {
  return answers_left_ > 0 || (request.kind == RequestKind::subscribe && clients_.contains(from_));
}

void Server::serve(const Request& request) {
  switch (request.kind) {
    case RequestKind::subscribe:
      subscribe(request);
      return;
    case RequestKind::unsubscribe:
      clients_.remove(from_);
      answer(writer_.hello(0.0));
      return;
    case RequestKind::query:
      answer_query(request.query);
      return;
    case RequestKind::reset:
      answer(actions_.reset(request.start_pose) ? writer_.reset_done()
                                                : writer_.error("a reset is under way"));
      return;
    case RequestKind::save:
      actions_.save(request.save, [this, to = from_](const SaveResult& result) {
        answer(writer_.saved(result), to);
      });
      return;
  }
}

void Server::subscribe(const Request& request) {
  const double ttl_s = std::clamp(request.ttl_s.value_or(config_.lease_s), kShortestLeaseS,
                                  std::max(kShortestLeaseS, config_.lease_s));
  const ClientTable::Client* client =
      clients_.renew(from_, monotonic_ns() + to_ns(ttl_s), request.wants);
  if (client == nullptr) {
    ++clients_refused_;
    answer(writer_.error("too many clients"));
  } else if (answers_left_ > 0) {
    const PointsGranted points{config_.scan_points, config_.map_points};
    answer(writer_.hello(ttl_s, client->has.points ? std::optional(points) : std::nullopt,
                         answer_packets(request.wants.packets, client->has.packets)));
  }
  if (client != nullptr && client->has.packets) actions_.packets_asked();
}

PacketsAnswer Server::answer_packets(bool wanted, bool has) const {
  if (!wanted) return PacketsAnswer::not_asked;
  if (has) return PacketsAnswer::granted;
  return config_.packets_clients > 0 ? PacketsAnswer::taken : PacketsAnswer::off;
}

void Server::answer_query(const std::string& query) {
  if (query == "hello") {
    answer(writer_.hello(0.0));
  } else if (query == "health") {
    answer(actions_.health());
  } else if (query == "pose") {
    const std::string_view pose = actions_.last_pose();
    answer(pose.empty() ? writer_.error("no pose yet") : pose);
  } else {
    answer(writer_.error("query: expected \"hello\", \"pose\" or \"health\""));
  }
}

void Server::answer(std::string_view datagram, const Endpoint& to) {
  --answers_left_;
  send_to(datagram, to);
}

// Whoever forged the sender gains nothing: what reaches the third party is no longer than what was
// spent on it.
void Server::answer_unproven(std::string_view datagram) {
  if (answers_to_unproven_left_ <= 0 || datagram.size() > request_bytes_) return;
  --answers_to_unproven_left_;
  send_to(datagram, from_);
}

bool Server::send_to(std::string_view datagram, const Endpoint& to) {
  error_code error;
  socket_.send_to(boost::asio::buffer(datagram.data(), datagram.size()), to, 0, error);
  if (error) ++send_errors_;
  return !error;
}

void Server::send(std::string_view datagram) {
  for (const ClientTable::Client& client : clients_.clients()) send_to(datagram, client.endpoint);
}

void Server::send_points(std::string_view datagram) {
  for (const ClientTable::Client& client : clients_.clients()) {
    if (client.has.points) send_to(datagram, client.endpoint);
  }
}

// Half of the buffer is poses'. What waits is what the network card has not taken yet, or has no
// hardware address for: a client that reads nothing costs no room.
bool Server::has_room_for_packets() {
  int waiting_bytes = 0;
  return ioctl(socket_.native_handle(), SIOCOUTQ, &waiting_bytes) != 0 ||
         waiting_bytes < send_buffer_bytes_ / 2;
}

void Server::send_packet(std::string_view datagram) {
  for (const ClientTable::Client& client : clients_.clients()) {
    if (!client.has.packets) continue;
    const bool sent = has_room_for_packets() && send_to(datagram, client.endpoint);
    ++(sent ? packets_sent_ : packets_not_sent_);
  }
}

void Server::tick() {
  clients_.expire(monotonic_ns());
  answers_left_ = kAnswersPerSecond;
  answers_to_unproven_left_ = kAnswersToUnprovenPerSecond;
}

}  // namespace lilo
