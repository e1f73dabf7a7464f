// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Poses from lilod, in one header: C++17, POSIX sockets, nothing else. daemon/PROTOCOL.md.
//
//   lilo::Client client;                      // 127.0.0.1:9871
//   lilo::ClientPose pose;
//   while (client.next(pose)) std::cout << pose.status << ' ' << pose.position[0] << '\n';

#include <arpa/inet.h>
#include <array>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <netinet/in.h>
#include <poll.h>
#include <string>
#include <sys/socket.h>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace lilo {

/// A direction along which the scan said too little.
struct ClientWeakDirection {
  std::array<double, 6> direction{};  // unit vector, x y z rx ry rz (m, rad), in the child frame
  double from_scan = 0.0;             // 0: prediction alone; 1: scan alone
};

struct ClientPose {
  std::string session;     // a new one: lilod started again, or was reset
  std::uint64_t seq = 0;   // a gap: datagrams were missed
  double timestamp = 0.0;  // UTC, s
  std::string frame_id, child_frame_id;
  std::string status;                         // initializing, tracking, degraded, lost
  std::array<double, 3> position{};           // m
  std::array<double, 4> orientation{};        // x y z w
  bool has_twist = false;                     // of the child frame:
  std::array<double, 3> linear{}, angular{};  // m/s, rad/s
  bool has_covariance = false;
  std::array<double, 36> covariance{};  // m, rad; row-major, x y z rx ry rz, in the child frame
  std::vector<ClientWeakDirection> weak_directions;  // the weakest first
  double latency_ms = 0.0;
};

/// A JSON object as paths and scalars: {"a":{"b":[1]}} is a/b/0 -> 1. Enough for this protocol.
class FlatJson {
 public:
  explicit FlatJson(const std::string& text) : text_(text) {
    good_ = value("") && (skip(), at_ == text_.size());
  }
  bool good() const { return good_; }
  bool has(const std::string& path) const {
    const auto found = scalars_.find(path);
    return found != scalars_.end();
  }
  std::string text(const std::string& path) const {
    const auto found = scalars_.find(path);
    return found == scalars_.end() ? std::string() : found->second;
  }
  double number(const std::string& path) const { return std::strtod(text(path).c_str(), nullptr); }

 private:
  void skip() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }
  bool take(char c) {
    skip();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  bool string(std::string& out) {
    if (!take('"')) return false;
    for (; at_ < text_.size() && text_[at_] != '"'; ++at_) {
      if (text_[at_] == '\\' && ++at_ >= text_.size()) return false;
      out += text_[at_];
    }
    return take('"');
  }
  static std::string join(const std::string& path, const std::string& name) {
    return path.empty() ? name : path + '/' + name;
  }
  bool value(const std::string& path) {
    if (++depth_ > 16) return false;
    const bool ok = take('{') ? members(path) : take('[') ? items(path) : scalar(path);
    --depth_;
    return ok;
  }
  bool members(const std::string& path) {
    if (take('}')) return true;
    do {
      std::string name;
      if (!string(name) || !take(':') || !value(join(path, name))) return false;
    } while (take(','));
    return take('}');
  }
  bool items(const std::string& path) {
    if (take(']')) return true;
    int index = 0;
    do {
      if (!value(join(path, std::to_string(index++)))) return false;
    } while (take(','));
    return take(']');
  }
  bool scalar(const std::string& path) {
    skip();
    if (at_ < text_.size() && text_[at_] == '"') return string(scalars_[path]);
    const std::size_t start = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) ||
                                  text_[at_] == '.' || text_[at_] == '-' || text_[at_] == '+'))
      ++at_;
    scalars_[path] = text_.substr(start, at_ - start);
    return at_ > start;
  }

  const std::string& text_;
  std::size_t at_ = 0;
  int depth_ = 0;
  bool good_ = false;
  std::map<std::string, std::string> scalars_;
};

/// Subscribes to a lilod, keeps the lease and survives its restarts. One thread.
class Client {
 public:
  /// Throws std::system_error when there is no socket to be had.
  explicit Client(const std::string& host = "127.0.0.1", std::uint16_t port = 9871)
      : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in server{};
    server.sin_family = AF_INET;
    server.sin_port = htons(port);
    if (socket_ < 0 || inet_pton(AF_INET, host.c_str(), &server.sin_addr) != 1 ||
        connect(socket_, reinterpret_cast<const sockaddr*>(&server), sizeof(server)) != 0)
      throw std::system_error(errno, std::generic_category(), "lilod at " + host);
  }
  ~Client() {
    request("\"unsubscribe\":{}");
    close(socket_);
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Waits for the next pose; false when none came in time.
  bool next(ClientPose& pose, std::chrono::milliseconds timeout = std::chrono::seconds(10)) {
    const auto deadline = Clock::now() + timeout;
    while (Clock::now() < deadline) {
      if (Clock::now() >= renew_at_) renew();
      pollfd ready{socket_, POLLIN, 0};
      if (poll(&ready, 1, 200) <= 0) continue;
      std::array<char, 2048> bytes{};
      const ssize_t size = recv(socket_, bytes.data(), bytes.size(), 0);
      if (size > 0 && take(std::string(bytes.data(), static_cast<std::size_t>(size)), pose))
        return true;
    }
    return false;
  }

  /// The body of any request of the protocol: request("\"reset\":{}").
  void request(const std::string& body) {
    std::string text = '{' + body + (token_.empty() ? "" : ",\"token\":\"" + token_ + '"') + '}';
    // Until we have shown a token, lilod's answer is no longer than what we send.
    if (text.size() < kRequestBytes) text.resize(kRequestBytes, ' ');
    // A refusal means that nobody listens yet; the lease is asked for again.
    [[maybe_unused]] const ssize_t sent = send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
  }

 private:
  static constexpr std::size_t kRequestBytes = 256;
  using Clock = std::chrono::steady_clock;

  void renew() {
    renew_at_ = Clock::now() + std::chrono::seconds(1);
    request("\"subscribe\":{\"ttl_s\":5}");
  }

  template <std::size_t N>
  static void read(const FlatJson& message, const std::string& path,
                   const std::array<const char*, N>& names, std::array<double, N>& out) {
    for (std::size_t k = 0; k < N; ++k) out[k] = message.number(path + '/' + names[k]);
  }

  bool take(const std::string& datagram, ClientPose& pose) {
    const FlatJson message(datagram);
    if (message.has("hello/token")) {  // we are not on its computer: show that we got this
      token_ = message.text("hello/token");
      renew_at_ = {};
    }
    if (!message.good() || !message.has("pose/status")) return false;
    const std::array<const char*, 3> xyz{"x", "y", "z"};
    const std::array<const char*, 4> xyzw{"x", "y", "z", "w"};
    pose.session = message.text("session");
    pose.seq = std::strtoull(message.text("seq").c_str(), nullptr, 10);
    pose.timestamp = message.number("timestamp");
    pose.frame_id = message.text("pose/frame_id");
    pose.child_frame_id = message.text("pose/child_frame_id");
    pose.status = message.text("pose/status");
    pose.latency_ms = message.number("pose/latency_ms");
    read(message, "pose/position", xyz, pose.position);
    read(message, "pose/orientation", xyzw, pose.orientation);
    pose.has_twist = message.has("pose/twist/linear/x");
    read(message, "pose/twist/linear", xyz, pose.linear);
    read(message, "pose/twist/angular", xyz, pose.angular);
    pose.has_covariance = message.has("pose/covariance/35");
    for (std::size_t k = 0; k < 36; ++k)
      pose.covariance[k] = message.number("pose/covariance/" + std::to_string(k));
    pose.weak_directions.clear();
    for (std::string weak = "pose/weak_directions/0"; message.has(weak + "/from_scan");
         weak = "pose/weak_directions/" + std::to_string(pose.weak_directions.size())) {
      ClientWeakDirection& added = pose.weak_directions.emplace_back();
      added.from_scan = message.number(weak + "/from_scan");
      for (std::size_t k = 0; k < 6; ++k)
        added.direction[k] = message.number(weak + "/direction/" + std::to_string(k));
    }
    return true;
  }

  int socket_;
  std::string token_;
  Clock::time_point renew_at_{};
};

}  // namespace lilo
