// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/view_command.hpp"

#include "tools/cli.hpp"
#include "tools/tool_config.hpp"
#include "tools/view/access.hpp"
#include "tools/view/daemon_link.hpp"
#include "tools/view/hub.hpp"
#include "tools/view/recording.hpp"
#include "tools/view/web_server.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/host_name.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <fmt/format.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lilo {
namespace {

using boost::system::error_code;
using nlohmann::json;

struct ViewOptions {
  std::string recording, config, sensor;
  std::string host = "127.0.0.1", listen = "127.0.0.1";
  std::uint16_t port = 8080, daemon_port = 9871;
  std::vector<std::string> origins{"https://app.foxglove.dev"};
  bool control = false;
};

// About ten minutes of a drive with points; more is thinned out.
constexpr std::size_t kLiveBytes = 64U << 20U, kRecordingBytes = 512U << 20U;

bool is_loopback(const std::string& address) {
  error_code error;
  const auto ip = boost::asio::ip::make_address(address, error);
  return !error && ip.is_loopback();
}

/// The view of one source, until Ctrl-C.
class View {
 public:
  explicit View(const ViewOptions& options)
      : options_(options),
        hub_(options.recording.empty() ? kLiveBytes : kRecordingBytes),
        access_(!is_loopback(options.listen), options.origins),
        control_token_(options.control ? view::new_secret() : std::string()),
        server_(io_, options.listen, options.port, hub_, access_,
                {control_token_, [this](const json& request) {
                   if (link_) link_->request(request);
                 }}) {
    server_.on_link_used = [this] { print_link("for the next browser:"); };
  }

  void run() {
    boost::asio::signal_set signals(io_, SIGINT, SIGTERM);
    signals.async_wait([this](const error_code&, int) { io_.stop(); });
    if (options_.recording.empty()) {
      link_.emplace(io_, options_.host, options_.daemon_port,
                    [this](std::string_view datagram) { hub_.take(datagram); });
      await_second();
    } else {
      play();
    }
    print_link(options_.recording.empty() ? "live, open in a browser:" : "open in a browser:");
    fmt::print("Foxglove, Lichtblick: ws://{}{}\n", place(),
               access_.links_needed() ? "/?key=" + access_.lasting_key() : "");
    fmt::print("Ctrl-C ends it\n");
    std::fflush(stdout);
    io_.run();
    recording_.reset();
  }

 private:
  /// Where browsers find us; of "any address" the user knows which of his it is.
  [[nodiscard]] std::string place() const {
    const bool any = options_.listen == "0.0.0.0" || options_.listen == "::";
    const bool v6 = options_.listen.find(':') != std::string::npos;
    const std::string name = any ? host_name() : v6 ? "[" + options_.listen + "]" : options_.listen;
    return fmt::format("{}:{}", name, server_.port());
  }

  static std::string host_name() {
    error_code error;
    const std::string name = boost::asio::ip::host_name(error);
    return error ? "localhost" : name;
  }

  void print_link(const char* what) {
    fmt::print("{} http://{}/{}{}\n", what, place(),
               access_.links_needed() ? "?key=" + access_.new_key() : "",
               control_token_.empty() ? "" : "#control=" + control_token_);
    std::fflush(stdout);
  }

  void await_second() {
    tell_live();
    second_.expires_after(std::chrono::seconds(1));
    second_.async_wait([this](const error_code& error) {
      if (!error) await_second();
    });
  }

  /// Only what changes is worth a line, or nobody could look back far.
  void tell(const json& state) {
    if (state == told_) return;
    told_ = state;
    hub_.tell(state);
  }

  void tell_live() {
    constexpr double kGone_s = 2.5;  // health comes every second
    const bool answers = link_->silent_s() < kGone_s;
    json state{{"mode", "live"},
               {"name", fmt::format("{}:{}", options_.host, options_.daemon_port)},
               {"answers", answers},
               {"control", !control_token_.empty()}};
    if (link_->was_answered()) state["points"] = link_->has_points();
    if (hub_.log().thinnings() > 0) state["thinned"] = hub_.log().thinnings();
    tell(state);
  }

  void play() {
    const Config config = tool_config(options_.config, {}, options_.sensor);
    const std::string name = std::filesystem::path(options_.recording).filename().string();
    recording_.emplace(
        options_.recording, config,
        [this](std::string_view datagram) {
          boost::asio::post(io_, [this, line = std::string(datagram)] { hub_.take(line); });
        },
        [this, name](const view::RecordingState& s) {
          json state{
              {"mode", "recording"}, {"name", name}, {"progress", s.progress}, {"done", s.done}};
          if (!s.error.empty()) state["error"] = s.error;
          boost::asio::post(io_, [this, state] { tell_recording(state); });
        });
  }

  void tell_recording(json state) {
    if (hub_.log().thinnings() > 0) state["thinned"] = hub_.log().thinnings();
    tell(state);
    if (state["done"] == true && hub_.malformed() > 0)
      fmt::print(stderr, "lilo: {}: {} lines are no datagrams of lilod\n", options_.recording,
                 hub_.malformed());
  }

  ViewOptions options_;
  boost::asio::io_context io_{1};
  boost::asio::steady_timer second_{io_};
  view::Hub hub_;
  view::Access access_;
  std::string control_token_;
  view::WebServer server_;
  std::optional<view::DaemonLink> link_;
  std::optional<view::Recording> recording_;
  json told_;
};

void run_view(const ViewOptions& options) { View(options).run(); }

}  // namespace

void add_view_command(CLI::App& app) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* sub = app.add_subcommand("view", "Show a running lilod or a recording in a browser");
  auto* recording = sub->add_option(
      "RECORDING", options->recording,
      "pcap, KITTI folder or recorded datagrams (.jsonl, .mcap); default: the running lilod");
  sub->add_option("--host", options->host, "Computer of the lilod")
      ->capture_default_str()
      ->excludes(recording);
  sub->add_option("--daemon-port", options->daemon_port, "Its subscribe.port")
      ->capture_default_str()
      ->excludes(recording);
  sub->add_option("--port", options->port, "TCP port browsers connect to; 0: any that is free")
      ->capture_default_str();
  sub->add_option("--listen", options->listen,
                  "Address to serve, as 0.0.0.0; other than loopback, a link that works once is "
                  "printed for each browser")
      ->capture_default_str();
  sub->add_flag("--control", options->control,
                "The page may reset the odometry and save map and trajectory")
      ->excludes(recording);
  sub->add_option("--allow-origin", options->origins,
                  "Site whose pages may connect by WebSocket, as Foxglove's")
      ->capture_default_str();
  sub->add_option("--config", options->config, "YAML configuration for the recording");
  sub->add_option("--sensor", options->sensor, "Sensor model, over the configuration's")
      ->type_name(choices(choices_of_key("sensor.model")));
  sub->callback([options] { run_view(*options); });
}

}  // namespace lilo
