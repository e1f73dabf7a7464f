// SPDX-License-Identifier: BSD-3-Clause
#include "tools/connection/connection.hpp"

#include "daemon/message_head.hpp"
#include "daemon/packet_message.hpp"
#include "tools/terminal/printable.hpp"

#include <boost/asio/buffer.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <poll.h>
#include <stdexcept>

namespace lilo {
namespace {

using boost::asio::ip::udp;
using nlohmann::json;

constexpr std::size_t kRequestBytes = 256;  // answers before the token are no longer than requests
constexpr std::chrono::milliseconds kAskAgain{500}, kRenew{1000};

std::string_view major_of(std::string_view version) { return version.substr(0, version.find('.')); }

bool is_answer(const json& message) {
  return message.contains("hello") || message.contains("done") || message.contains("error");
}

}  // namespace

std::string to_string(const LilodAddress& address) {
  const bool ipv6 = address.host.find(':') != std::string::npos;
  return ipv6 ? fmt::format("[{}]:{}", address.host, address.port)
              : fmt::format("{}:{}", address.host, address.port);
}

Connection::Connection(const LilodAddress& address, Milliseconds patience)
    : address_(address), socket_(io_) {
  connect();
  greet(patience);
}

Connection::~Connection() {
  if (!renew_at_) return;
  // A daemon that does not hear it ends the subscription by itself.
  try {
    send({{"unsubscribe", json::object()}});
  } catch (const std::exception&) {
    return;
  }
}

void Connection::connect() {
  boost::system::error_code error;
  udp::resolver resolver(io_);
  const auto found = resolver.resolve(address_.host, std::to_string(address_.port), error);
  if (error || found.empty()) {
    throw std::runtime_error(fmt::format("{}: expected a name or an address, found: {}",
                                         address_.host, error ? error.message() : "none"));
  }
  const udp::endpoint endpoint = found.begin()->endpoint();
  socket_.open(endpoint.protocol(), error);
  if (!error) socket_.connect(endpoint, error);  // only what this daemon sends comes in
  if (error) throw std::runtime_error(fmt::format("{}: {}", to_string(address_), error.message()));
  socket_.set_option(boost::asio::socket_base::receive_buffer_size(4 << 20), error);  // or less
  socket_.non_blocking(true);
}

// Asking again is harmless here, so a lost datagram does not matter; requests that change something
// are sent once, to a daemon that is known to answer.
void Connection::greet(Milliseconds patience) {
  const auto deadline = Clock::now() + patience;
  while (Clock::now() < deadline && !refused_) {
    send({{"query", "hello"}});
    const auto again = std::min(Clock::now() + kAskAgain, deadline);
    while (wait(again, -1) == Waited::datagram) {
      const auto datagram = take();
      if (!datagram) break;
      const json message = understood(*datagram);
      if (!message.contains("hello")) continue;
      software_ = printable(message["hello"].value("software", "lilod"));
      if (!message["hello"].contains("token")) return;
      send({{"query", "hello"}});  // with the token it gave us
    }
  }
  throw std::runtime_error(no_answer(patience));
}

json Connection::ask(const json& request, const std::string& kind, Milliseconds patience) {
  send(request);
  const auto deadline = Clock::now() + patience;
  while (wait(deadline, -1) == Waited::datagram) {
    const auto datagram = take();
    if (!datagram) continue;
    json message = understood(*datagram);
    if (message.contains(kind)) return message;
    if (message.contains("error")) {
      throw std::runtime_error(fmt::format("{}: {}", to_string(address_),
                                           printable(message["error"].value("reason", "refused"))));
    }
  }
  throw std::runtime_error(no_answer(patience));
}

void Connection::subscribe(Subscription what) {
  subscription_ = what;
  renew();
  if (what == Subscription::with_packets) await_packets();
}

// The answer comes before the first packet, so none is missed. Poses before it are.
void Connection::await_packets() {
  const auto deadline = Clock::now() + kPatience;
  while (Clock::now() < deadline) {
    const auto again = std::min(Clock::now() + kAskAgain, deadline);
    while (wait(again, -1) == Waited::datagram) {
      const auto datagram = take();
      if (datagram && !is_packet(*datagram) && has_packets(understood(*datagram))) return;
    }
    renew();
  }
  throw std::runtime_error(no_answer(kPatience));
}

void Connection::renew() {
  renew_at_ = Clock::now() + kRenew;
  json what{{"ttl_s", 5}};
  if (subscription_ == Subscription::with_packets) what["packets"] = true;
  send({{"subscribe", what}});
}

std::optional<std::string_view> Connection::receive(Milliseconds at_most, int or_readable) {
  const auto deadline = Clock::now() + at_most;
  for (;;) {
    if (renew_at_ && Clock::now() >= *renew_at_) renew();
    const auto until = renew_at_ ? std::min(deadline, *renew_at_) : deadline;
    const Waited waited = wait(until, or_readable);
    if (waited == Waited::other) return {};
    if (waited == Waited::in_vain && until == deadline) return {};
    if (waited == Waited::in_vain) continue;
    const auto datagram = take();
    if (!datagram) continue;
    if (is_packet(*datagram)) return datagram;
    const json message = understood(*datagram);
    if (has_packets(message)) continue;
    if (!message.empty() && !is_answer(message)) return datagram;
  }
}

void Connection::send(json request) {
  if (!token_.empty()) request["token"] = token_;
  std::string text = request.dump();
  if (text.size() < kRequestBytes) text.resize(kRequestBytes, ' ');
  boost::system::error_code error;  // that nobody listens is seen by who waits for the answer
  socket_.send(boost::asio::buffer(text), 0, error);
}

Connection::Waited Connection::wait(Clock::time_point until, int or_readable) {
  const auto left = std::chrono::ceil<Milliseconds>(until - Clock::now());
  std::array<pollfd, 2> waiting{{{socket_.native_handle(), POLLIN, 0}, {or_readable, POLLIN, 0}}};
  const int ready =
      poll(waiting.data(), waiting.size(), std::max(0, static_cast<int>(left.count())));
  if (ready == 0) return Waited::in_vain;
  return ready > 0 && waiting[1].revents == 0 ? Waited::datagram : Waited::other;
}

std::optional<std::string_view> Connection::take() {
  boost::system::error_code error;
  const std::size_t size = socket_.receive(boost::asio::buffer(buffer_), 0, error);
  refused_ = error == boost::asio::error::connection_refused;
  if (error) return std::nullopt;
  return std::string_view(buffer_.data(), size);
}

/// Takes note of a token on the way. Throws when the daemon speaks another protocol than we.
json Connection::understood(std::string_view datagram) {
  json message = json::parse(datagram, nullptr, /*allow_exceptions=*/false);
  if (!message.is_object()) return json::object();
  const std::string version = message.value("v", "");
  if (major_of(version) != major_of(kProtocolVersion)) {
    throw std::runtime_error(
        fmt::format("{}: expected protocol {}.x, found {}: use the lilo of that lilod",
                    to_string(address_), major_of(kProtocolVersion), printable(version)));
  }
  const json& hello = message.contains("hello") ? message["hello"] : json::object();
  if (hello.contains("token")) token_ = hello["token"].get<std::string>();
  if (hello.contains("token") && renew_at_) renew_at_ = Clock::time_point{};
  return message;
}

// Whether it is the answer to a subscription (one without a lease answers something else) and
// grants us packets. Throws when it refuses them.
bool Connection::has_packets(const json& message) const {
  if (subscription_ != Subscription::with_packets || !message.contains("hello")) return false;
  const json& hello = message["hello"];
  if (hello.value("ttl_s", 0.0) <= 0.0) return false;
  const std::string packets = hello.value("packets", "unknown");
  if (packets == "granted") return true;
  const char* why = "this lilod cannot: it is older than this lilo";
  if (packets == "off") why = "set subscribe.packets_clients in its configuration";
  if (packets == "taken")
    why = "other clients have them, as many as subscribe.packets_clients says";
  throw std::runtime_error(fmt::format("{}: sends no packets: {}", to_string(address_), why));
}

std::string Connection::no_answer(Milliseconds patience) const {
  if (refused_) return fmt::format("{}: no lilod listens there", to_string(address_));
  boost::system::error_code error;
  const auto here = socket_.local_endpoint(error).address();
  std::string text = fmt::format("{}: no answer for {:g} s", to_string(address_),
                                 std::chrono::duration<double>(patience).count());
  if (error || here.is_loopback()) return text;
  return text + fmt::format(
                    ": is lilod running there, with subscribe.bind_address {} and {} in "
                    "subscribe.allow?",
                    here.is_v6() ? "\"::\"" : "0.0.0.0", here.to_string());
}

}  // namespace lilo
