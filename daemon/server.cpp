#include "daemon/server.hpp"

#include "daemon/clock.hpp"
#include "daemon/pose_message.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/address_v4.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace lilo {
namespace {

namespace ip = boost::asio::ip;
using boost::system::error_code;

constexpr int kAnswersPerSecond = 200;
constexpr double kShortestLeaseS = 1.0;

std::int64_t to_ns(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

}  // namespace

Server::Server(boost::asio::io_context& io, const SubscribeConfig& config,
               const PublishConfig& publish, ServerActions actions)
    : socket_(io),
      config_(config),
      publish_(publish),
      actions_(std::move(actions)),
      clients_(static_cast<std::size_t>(config.max_clients)),
      answers_left_(kAnswersPerSecond) {
  if (config.port == 0) return;
  const Endpoint local(ip::make_address_v4(config.bind_address), config.port);
  error_code error;
  socket_.open(ip::udp::v4());
  socket_.bind(local, error);
  if (error) {
    throw std::runtime_error(fmt::format("subscribe: cannot listen on {}:{}: {}",
                                         config.bind_address, config.port, error.message()));
  }
  socket_.non_blocking(true);
  await_request();
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
  const ip::address address = from.address();
  if (address.is_loopback()) return true;
  return std::find(config_.allow.begin(), config_.allow.end(), address.to_string()) !=
         config_.allow.end();
}

// That the sender receives what goes to its address: a packet from the loopback network cannot come
// from outside, and others have sent back a token.
bool Server::is_proven(const Request& request) const {
  if (from_.address().is_loopback()) return true;
  return tokens_.accept(request.token, from_.address().to_v4().to_uint(), from_.port(),
                        monotonic_ns());
}

void Server::handle(std::string_view datagram) {
  if (!is_known(from_) || answers_left_ <= 0) {
    ++requests_refused_;
    return;
  }
  const ParsedRequest parsed = parse_request(datagram);
  if (!parsed.request) {
    ++requests_refused_;
    if (from_.address().is_loopback() || clients_.contains(from_)) say_error(parsed.error);
    return;
  }
  if (!is_proven(*parsed.request)) {
    say_hello(0.0, true);
    return;
  }
  serve(*parsed.request);
}

void Server::serve(const Request& request) {
  switch (request.kind) {
    case RequestKind::subscribe: {
      const double ttl_s = std::clamp(request.ttl_s.value_or(config_.lease_s), kShortestLeaseS,
                                      std::max(kShortestLeaseS, config_.lease_s));
      if (clients_.renew(from_, monotonic_ns() + to_ns(ttl_s))) {
        say_hello(ttl_s, false);
      } else {
        say_error("too many clients");
      }
      return;
    }
    case RequestKind::unsubscribe:
      clients_.remove(from_);
      say_hello(0.0, false);
      return;
    case RequestKind::query:
      answer_query(request.query);
      return;
    case RequestKind::reset:
      if (!actions_.reset(request.start_pose)) {
        say_error("a reset is under way");
        return;
      }
      begin(json_);
      json_.begin_object("done");
      json_.text("request", "reset");
      json_.end_object();
      answer(json_.finish());
      return;
    case RequestKind::save:
      actions_.save(request.save,
                    [this, to = from_](const SaveResult& result) { say_saved(result, to); });
      return;
  }
}

void Server::say_saved(const SaveResult& result, const Endpoint& to) {
  if (!result.error.empty()) {
    say_error(result.error, to);
    return;
  }
  begin(json_);
  json_.begin_object("done");
  json_.text("request", "save");
  json_.text("file", result.file);
  json_.unsigned_integer("count", result.count);
  json_.end_object();
  answer(json_.finish(), to);
}

void Server::answer_query(const std::string& query) {
  if (query == "hello") {
    say_hello(0.0, false);
  } else if (query == "health") {
    answer(actions_.health());
  } else if (query == "pose") {
    const std::string_view pose = actions_.last_pose();
    if (pose.empty()) {
      say_error("no pose yet");
    } else {
      answer(pose);
    }
  } else {
    say_error("query: expected \"hello\", \"pose\" or \"health\"");
  }
}

void Server::begin(JsonWriter& out) {
  out = JsonWriter();
  out.text("v", kProtocolVersion);
  out.seconds("timestamp", realtime_ns());
  out.text("session", actions_.session());
}

void Server::say_hello(double ttl_s, bool with_token) {
  begin(json_);
  json_.begin_object("hello");
  json_.text("software", "lilod " LILO_VERSION);
  json_.number("ttl_s", ttl_s, 3);
  if (with_token) {
    json_.text("token",
               tokens_.make(from_.address().to_v4().to_uint(), from_.port(), monotonic_ns()));
  } else {
    json_.text("frame_id", publish_.frame_id);
    json_.text("child_frame_id", publish_.child_frame_id);
  }
  json_.end_object();
  answer(json_.finish());
}

void Server::say_error(std::string_view why, const Endpoint& to) {
  begin(json_);
  json_.begin_object("error");
  json_.text("reason", why);
  json_.end_object();
  answer(json_.finish(), to);
}

void Server::answer(std::string_view datagram, const Endpoint& to) {
  --answers_left_;
  send_to(datagram, to);
}

void Server::send_to(std::string_view datagram, const Endpoint& to) {
  error_code error;
  socket_.send_to(boost::asio::buffer(datagram.data(), datagram.size()), to, 0, error);
  if (error) ++send_errors_;
}

void Server::send(std::string_view datagram) {
  for (const ClientTable::Client& client : clients_.clients()) send_to(datagram, client.endpoint);
}

void Server::tick() {
  clients_.expire(monotonic_ns());
  answers_left_ = kAnswersPerSecond;
}

}  // namespace lilo
