// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>

#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace lilo::view {

using HttpRequest = boost::beast::http::request<boost::beast::http::string_body>;

/// A WebSocket of the server. It owns itself while it is open: handlers that are under way hold it.
class WebSocket : public std::enable_shared_from_this<WebSocket> {
 public:
  struct Handlers {
    std::function<void()> opened;
    std::function<void(std::string_view)> text;
    /// Something can be sent: gives the next message, or nothing for now.
    std::function<bool(std::string& message, bool& is_binary)> next;
    std::function<void()> closed;
  };

  explicit WebSocket(boost::beast::tcp_stream&& stream);

  /// Answers the request; `protocol`: the subprotocol to agree on, or empty.
  void accept(const HttpRequest& request, const std::string& protocol, Handlers handlers);
  /// Takes what `next` gives, until that is nothing.
  void send_more();

 private:
  void read();
  void close();

  boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
  boost::beast::flat_buffer received_;
  std::string sending_;
  bool is_open_ = false, is_sending_ = false;
  Handlers handlers_;
};

}  // namespace lilo::view
