// SPDX-License-Identifier: BSD-3-Clause
#include "tools/listen/listen_command.hpp"

#include "daemon/message_head.hpp"
#include "tools/cli.hpp"
#include "tools/connection/connection.hpp"
#include "tools/listen/pose_message.hpp"
#include "tools/stop_signals.hpp"
#include "tools/terminal/printable.hpp"
#include "tools/text_file.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <poll.h>
#include <stdexcept>

namespace lilo {
namespace {

using boost::asio::ip::udp;

struct ListenOptions {
  std::uint16_t port = 9870;
  LilodAddress lilod{.host = ""};  // empty: listen as a sink
  bool json = false;
  std::string tum;
  std::uint64_t count = 0;  // 0: no end
  double timeout_s = 0.0;   // 0: no end
};

/// Prints what arrives, keeps the trajectory and the score.
class Listener {
 public:
  explicit Listener(const ListenOptions& options) : options_(options) {
    if (!options.tum.empty()) tum_.emplace(create_text(options.tum));
  }

  void take(std::string_view datagram) {
    PoseMessage message;
    const MessageKind kind = parse_message(datagram, message);
    malformed_ += kind == MessageKind::malformed ? 1 : 0;
    other_versions_ += kind == MessageKind::other_version ? 1 : 0;
    if (kind == MessageKind::malformed || kind == MessageKind::other_version) return;
    if (kind == MessageKind::pose) take_pose(message);
    if (options_.json) {
      fmt::print("{}\n", printable(datagram));
    } else if (kind == MessageKind::other) {
      fmt::print("{}", other_line(datagram));
    } else if (kind == MessageKind::pose) {
      if (poses_ == 1) fmt::print("{}", pose_heading());
      fmt::print("{}", pose_line(message));
    }
    std::fflush(stdout);
  }

  [[nodiscard]] bool finished() const { return options_.count > 0 && poses_ >= options_.count; }

  [[nodiscard]] std::string summary() const {
    std::string text = fmt::format("{} poses, {} missed", poses_, missed_);
    if (malformed_ > 0) text += fmt::format(", {} datagrams not understood", malformed_);
    if (other_versions_ > 0) {
      text += fmt::format(", {} datagrams of another protocol than {}", other_versions_,
                          kProtocolVersion);
    }
    return text;
  }

  [[nodiscard]] std::uint64_t poses() const { return poses_; }

 private:
  void take_pose(const PoseMessage& message) {
    const bool same_session = poses_ > 0 && message.session == session_;
    if (same_session && message.seq > seq_ + 1) missed_ += message.seq - seq_ - 1;
    session_ = message.session;
    seq_ = message.seq;
    ++poses_;
    if (!tum_) return;
    *tum_ << tum_line(message.pose) << '\n';
    finish_text(*tum_, options_.tum);  // every line: whoever ends this may be in a hurry
  }

  ListenOptions options_;
  std::optional<std::ofstream> tum_;
  std::uint64_t poses_ = 0, missed_ = 0, malformed_ = 0, other_versions_ = 0, seq_ = 0;
  std::string session_;
};

/// The sink's port; closed when another program has it.
udp::socket bind_socket(boost::asio::io_context& io, std::uint16_t port) {
  udp::socket socket(io, udp::v4());
  boost::system::error_code error;
  socket.bind({udp::v4(), port}, error);
  if (error == boost::asio::error::address_in_use) socket.close();
  if (error && socket.is_open())
    throw std::runtime_error(fmt::format("UDP port {}: {}", port, error.message()));
  return socket;
}

/// Until a datagram is there (true), the time is over or Ctrl-C was pressed (false).
bool wait_for_datagram(udp::socket& socket, StopSignals& stop, double timeout_s) {
  const int timeout_ms = timeout_s > 0.0 ? static_cast<int>(timeout_s * 1e3) : -1;
  std::array<pollfd, 2> waiting{
      {{socket.native_handle(), POLLIN, 0}, {stop.descriptor(), POLLIN, 0}}};
  return poll(waiting.data(), waiting.size(), timeout_ms) > 0 && !stop.raised();
}

void listen_as_sink(udp::socket& socket, const ListenOptions& options, StopSignals& stop,
                    Listener& listener) {
  std::array<char, 65536> buffer{};
  while (!listener.finished() && wait_for_datagram(socket, stop, options.timeout_s)) {
    udp::endpoint sender;
    const std::size_t size = socket.receive_from(boost::asio::buffer(buffer), sender);
    listener.take({buffer.data(), size});
  }
}

void listen_as_subscriber(const LilodAddress& address, const ListenOptions& options,
                          StopSignals& stop, Listener& listener) {
  Connection lilod(address);
  lilod.subscribe();
  const auto patience = options.timeout_s > 0.0
                            ? Connection::Milliseconds(static_cast<int>(options.timeout_s * 1e3))
                            : Connection::Milliseconds(std::chrono::hours(24 * 365));
  while (!listener.finished() && !stop.raised()) {
    const auto datagram = lilod.receive(patience, stop.descriptor());
    if (!datagram) return;
    listener.take(*datagram);
  }
}

/// How and where it listened, for messages.
std::string listen(const ListenOptions& options, StopSignals& stop, Listener& listener) {
  LilodAddress lilod = options.lilod;
  if (lilod.host.empty()) {
    boost::asio::io_context io;
    udp::socket socket = bind_socket(io, options.port);
    if (socket.is_open()) {
      listen_as_sink(socket, options, stop, listener);
      return fmt::format("on UDP port {}", options.port);
    }
    lilod.host = LilodAddress().host;
    fmt::print(stderr, "UDP port {} is another program's: subscribing to {} instead\n",
               options.port, to_string(lilod));
  }
  listen_as_subscriber(lilod, options, stop, listener);
  return "from " + to_string(lilod);
}

void run_listen(const ListenOptions& options) {
  StopSignals stop;
  Listener listener(options);
  const std::string where = listen(options, stop, listener);
  const bool enough = options.count > 0 ? listener.finished() : listener.poses() > 0;
  if (!enough && !stop.raised()) {
    throw std::runtime_error(fmt::format("nothing more arrived {} for {:g} s: {}", where,
                                         options.timeout_s, listener.summary()));
  }
  fmt::print(stderr, "{}\n", listener.summary());
}

}  // namespace

void add_listen_command(CLI::App& app) {
  auto options = std::make_shared<ListenOptions>();
  CLI::App* sub = app.add_subcommand("listen", "Print the poses lilod sends");
  sub->add_option(
         "--port", options->port,
         "UDP port that lilod has as a sink; when another program has it, listen subscribes")
      ->capture_default_str();
  sub->add_option("--host", options->lilod.host, "Subscribe to the lilod on this computer instead");
  sub->add_option("--request-port", options->lilod.port, "Its subscribe.port")
      ->capture_default_str();
  sub->add_flag("--json", options->json, "Print the datagrams as they are, one a line");
  sub->add_option("--tum", options->tum, "Also write the poses to this TUM file");
  sub->add_option("--count", options->count, "End after so many poses")->check(above_zero());
  sub->add_option(
         "--timeout", options->timeout_s,
         "End when nothing, health included, has arrived for so many seconds; an error without a "
         "pose, or before --count")
      ->check(above_zero());
  sub->callback([options] { run_listen(*options); });
}

}  // namespace lilo
