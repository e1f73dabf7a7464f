// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/web_server.hpp"

#include "tools/view/foxglove_session.hpp"
#include "tools/view/page_files.hpp"

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

namespace lilo::view {
namespace {

namespace http = boost::beast::http;
using boost::asio::ip::tcp;
using boost::system::error_code;
using nlohmann::json;
using Answer = http::response<http::string_body>;

constexpr int kMostConnections = 64;
constexpr std::size_t kMostStreams = 64;
constexpr std::size_t kMostRequest = 16384;  // bytes
constexpr std::size_t kMessage = 1U << 18U;  // bytes of a message to a page, about
constexpr auto kPatience = std::chrono::seconds(15);

std::string_view view_of(boost::beast::string_view text) { return {text.data(), text.size()}; }

std::string_view path_of(std::string_view target) {
  target.remove_prefix(target.starts_with('/') ? 1 : 0);
  return target.substr(0, target.find('?'));
}

/// The value of `name` behind the question mark; our own values need no decoding.
std::string_view parameter(std::string_view target, std::string_view name) {
  const std::size_t question = target.find('?');
  if (question == std::string_view::npos) return {};
  std::string_view rest = target.substr(question + 1);
  while (!rest.empty()) {
    const std::string_view pair = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(rest.size(), pair.size() + 1));
    if (pair.starts_with(name) && pair.substr(name.size()).starts_with('='))
      return pair.substr(name.size() + 1);
  }
  return {};
}

Answer answer_with(const HttpRequest& request, http::status status, std::string_view type,
                   std::string_view body) {
  Answer answer{status, request.version()};
  answer.set(http::field::server, "lilo view");
  answer.set(http::field::content_type, boost::beast::string_view(type.data(), type.size()));
  answer.set(http::field::cache_control, "no-store");
  answer.set("X-Content-Type-Options", "nosniff");
  answer.set("Referrer-Policy", "no-referrer");
  answer.set("Cross-Origin-Resource-Policy", "same-origin");
  answer.set("Content-Security-Policy",
             "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
             "img-src 'self' data:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'");
  answer.keep_alive(request.keep_alive());
  answer.body() = std::string(body);
  answer.prepare_payload();
  if (request.method() == http::verb::head) answer.body().clear();
  return answer;
}

}  // namespace

/// One connection until it ends or becomes a WebSocket.
class WebServer::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(WebServer& server, tcp::socket socket)
      : server_(server), count_(server.connections_), stream_(std::move(socket)) {
    ++*count_;
  }
  ~Connection() { --*count_; }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void read() {
    parser_.emplace();
    parser_->body_limit(kMostRequest);
    parser_->header_limit(kMostRequest);
    stream_.expires_after(kPatience);
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](const error_code& error, std::size_t) {
                       if (!error) self->serve(self->parser_->release());
                     });
  }

 private:
  void serve(const HttpRequest& request) {
    const auto field = [&](http::field name) { return view_of(request[name]); };
    const std::string_view target = view_of(request.target());
    const std::string_view host = field(http::field::host), key = parameter(target, "key");
    if (server_.access_.links_needed()) {
      const std::string cookie = server_.access_.redeem(key);
      if (!cookie.empty()) return admit(request, cookie);
    }
    if (!server_.access_.may_read(host, field(http::field::cookie), key))
      return refuse(request, "this view needs the link that lilo view printed\n");
    if (boost::beast::websocket::is_upgrade(request)) return upgrade(request, host);
    if (request.method() != http::verb::get && request.method() != http::verb::head)
      return write(answer_with(request, http::status::method_not_allowed, "text/plain", ""));
    const PageFile* file = find_page_file(path_of(target));
    if (file == nullptr)
      return write(answer_with(request, http::status::not_found, "text/plain", "not found\n"));
    write(answer_with(request, http::status::ok, file->type, file->text));
  }

  void admit(const HttpRequest& request, const std::string& cookie) {
    Answer answer = answer_with(request, http::status::see_other, "text/plain", "");
    answer.set(http::field::location, "/");
    answer.set(http::field::set_cookie,
               "lilo_view=" + cookie + "; Path=/; HttpOnly; SameSite=Strict");
    write(std::move(answer));
    if (server_.on_link_used) server_.on_link_used();
  }

  void refuse(const HttpRequest& request, std::string_view why) {
    write(answer_with(request, http::status::forbidden, "text/plain", why));
  }

  void upgrade(const HttpRequest& request, std::string_view host) {
    if (!server_.access_.is_origin_good(view_of(request[http::field::origin]), host))
      return refuse(request, "pages of other sites may not connect\n");
    if (server_.hub_.members() >= kMostStreams) return refuse(request, "too many streams\n");
    if (request[http::field::sec_websocket_protocol].empty()) {
      server_.open_page_stream(std::move(stream_), request);
    } else {
      server_.open_foxglove(std::move(stream_), request);
    }
  }

  void write(Answer&& answer) {
    answer_ = std::move(answer);
    http::async_write(stream_, answer_,
                      [self = shared_from_this()](const error_code& error, std::size_t) {
                        if (error) return;
                        if (self->answer_.need_eof()) {
                          error_code ignored;
                          self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
                        } else {
                          self->read();
                        }
                      });
  }

  WebServer& server_;
  std::shared_ptr<int> count_;
  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  Answer answer_;
};

WebServer::WebServer(boost::asio::io_context& io, const std::string& address, std::uint16_t port,
                     Hub& hub, Access& access, Control control)
    : acceptor_(io), hub_(hub), access_(access), control_(std::move(control)) {
  error_code error;
  const auto ip = boost::asio::ip::make_address(address, error);
  if (error) throw std::runtime_error(fmt::format("expected an IP address, found {}", address));
  const tcp::endpoint local(ip, port);
  acceptor_.open(local.protocol());
  acceptor_.set_option(tcp::acceptor::reuse_address(true));
  acceptor_.bind(local, error);
  if (!error) acceptor_.listen(tcp::acceptor::max_listen_connections, error);
  if (error)
    throw std::runtime_error(
        fmt::format("cannot listen on {}:{}: {}", address, port, error.message()));
  accept();
}

void WebServer::accept() {
  acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
    if (error == boost::asio::error::operation_aborted) return;
    if (!error && *connections_ < kMostConnections)
      std::make_shared<Connection>(*this, std::move(socket))->read();
    accept();
  });
}

/// The whole past first, then what comes.
void WebServer::open_page_stream(boost::beast::tcp_stream&& stream, const HttpRequest& request) {
  const auto socket = std::make_shared<WebSocket>(std::move(stream));
  const auto position = std::make_shared<std::uint64_t>(0);
  const auto member = std::make_shared<std::uint64_t>(0);
  std::weak_ptr<WebSocket> weak = socket;
  socket->accept(request, "",
                 {.opened =
                      [this, weak, member] {
                        *member = hub_.join([weak] {
                          if (const auto open = weak.lock()) open->send_more();
                        });
                      },
                  .text = [this](std::string_view text) { take_command(text); },
                  .next =
                      [this, position](std::string& message, bool&) {
                        *position = hub_.log().read_after(*position, kMessage, message);
                        return !message.empty();
                      },
                  .closed = [this, member] { hub_.leave(*member); }});
}

void WebServer::open_foxglove(boost::beast::tcp_stream&& stream, const HttpRequest& request) {
  const std::string offered(view_of(request[http::field::sec_websocket_protocol]));
  const std::string protocol = foxglove_protocol(offered);
  const auto socket = std::make_shared<WebSocket>(std::move(stream));
  const auto session = std::make_shared<FoxgloveSession>(hub_.log());
  const auto member = std::make_shared<std::uint64_t>(0);
  std::weak_ptr<WebSocket> weak = socket;
  socket->accept(request, protocol,
                 {.opened =
                      [this, weak, member] {
                        *member = hub_.join([weak] {
                          if (const auto open = weak.lock()) open->send_more();
                        });
                      },
                  .text = [session](std::string_view text) { session->take(text); },
                  .next = [session](std::string& message,
                                    bool& is_binary) { return session->next(message, is_binary); },
                  .closed = [this, member] { hub_.leave(*member); }});
}

/// Nothing is said about what is refused: there is nobody to say it to but who tries.
void WebServer::take_command(std::string_view text) {
  const json message = json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (control_.token.empty() || !message.is_object() || !message.contains("token") ||
      !message["token"].is_string() || !message.contains("request"))
    return;
  if (!is_same_secret(message["token"].get_ref<const std::string&>(), control_.token)) return;
  static const std::array<json, 3> kAllowed{json{{"reset", json::object()}}, json{{"save", "map"}},
                                            json{{"save", "trajectory"}}};
  for (const json& allowed : kAllowed) {
    if (message["request"] == allowed) control_.request(allowed);
  }
}

}  // namespace lilo::view
