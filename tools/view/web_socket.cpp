// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/web_socket.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/http/field.hpp>

#include <utility>

namespace lilo::view {
namespace {

namespace websocket = boost::beast::websocket;
using boost::system::error_code;

constexpr std::size_t kMostReceived = 65536;  // bytes of a message

}  // namespace

WebSocket::WebSocket(boost::beast::tcp_stream&& stream) : stream_(std::move(stream)) {}

void WebSocket::accept(const HttpRequest& request, const std::string& protocol, Handlers handlers) {
  handlers_ = std::move(handlers);
  boost::beast::get_lowest_layer(stream_).expires_never();
  stream_.set_option(websocket::stream_base::timeout::suggested(boost::beast::role_type::server));
  stream_.set_option(
      websocket::stream_base::decorator([protocol](websocket::response_type& answer) {
        if (!protocol.empty())
          answer.set(boost::beast::http::field::sec_websocket_protocol, protocol);
      }));
  stream_.read_message_max(kMostReceived);
  stream_.async_accept(request, [self = shared_from_this()](const error_code& error) {
    if (error) return self->close();
    self->is_open_ = true;
    self->handlers_.opened();
    self->read();
    self->send_more();
  });
}

void WebSocket::read() {
  stream_.async_read(received_, [self = shared_from_this()](const error_code& error, std::size_t) {
    if (error) return self->close();
    const std::string text = boost::beast::buffers_to_string(self->received_.data());
    self->received_.clear();
    self->handlers_.text(text);
    self->send_more();
    self->read();
  });
}

void WebSocket::send_more() {
  bool is_binary = false;
  if (!is_open_ || is_sending_ || !handlers_.next(sending_, is_binary)) return;
  is_sending_ = true;
  stream_.binary(is_binary);
  stream_.async_write(boost::asio::buffer(sending_),
                      [self = shared_from_this()](const error_code& error, std::size_t) {
                        self->is_sending_ = false;
                        if (error) return self->close();
                        self->send_more();
                      });
}

void WebSocket::close() {
  is_open_ = false;
  if (const auto closed = std::exchange(handlers_.closed, {})) closed();
}

}  // namespace lilo::view
