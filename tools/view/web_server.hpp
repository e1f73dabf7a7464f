// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/view/access.hpp"
#include "tools/view/hub.hpp"
#include "tools/view/web_socket.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace lilo::view {

/// What the browsers may do besides looking on: nothing unless `token` is set.
struct Control {
  std::string token;  ///< empty: no commands at all
  std::function<void(const nlohmann::json& request)> request;
};

/// Serves the page, streams to pages and to Foxglove. One thread, that of the io_context.
class WebServer {
 public:
  /// Throws std::runtime_error when it cannot listen there. Port 0: any.
  WebServer(boost::asio::io_context& io, const std::string& address, std::uint16_t port, Hub& hub,
            Access& access, Control control);

  [[nodiscard]] std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
  /// Called when a link was used up: the next browser needs another.
  std::function<void()> on_link_used;

 private:
  class Connection;
  void accept();
  void open_page_stream(boost::beast::tcp_stream&& stream, const HttpRequest& request);
  void open_foxglove(boost::beast::tcp_stream&& stream, const HttpRequest& request);
  void take_command(std::string_view text);

  boost::asio::ip::tcp::acceptor acceptor_;
  Hub& hub_;
  Access& access_;
  Control control_;
  /// Connections that are no WebSocket yet; they may outlive the server in its io_context.
  std::shared_ptr<int> connections_ = std::make_shared<int>(0);
};

}  // namespace lilo::view
