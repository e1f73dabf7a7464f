// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Poses from lilod, in one header: C++17, POSIX sockets, nothing else. lilod-protocol(7).
//
//   lilo::Client client;                      // 127.0.0.1:9871
//   lilo::ClientPose pose;
//   while (client.next(pose)) std::cout << pose.status << ' ' << pose.position[0] << '\n';
//   std::cerr << client.why() << '\n';        // why there was none

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <map>
#include <netdb.h>
#include <poll.h>
#include <stdexcept>
#include <string>
#include <sys/socket.h>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>
#if !defined(__cpp_lib_to_chars)
#include <locale>
#include <sstream>
#endif

namespace lilo {

/// A direction along which the scan said too little.
struct ClientWeakDirection {
  std::array<double, 6> direction{};  // unit vector, x y z rx ry rz (m, rad), in the child frame
  double from_scan = 0.0;             // 0: prediction alone; 1: scan alone
};

struct ClientPose {
  std::string session;
  bool new_session = false;   // the first pose, or of another session than the one before: another
                              // origin, so compare it with no earlier pose
  std::uint64_t seq = 0;      // a gap within a session: datagrams were missed
  double timestamp = 0.0;     // UTC, s
  std::int64_t stamp_ns = 0;  // the same, exactly
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
  // NOLINTNEXTLINE(readability-container-contains): C++17
  bool has(const std::string& path) const { return scalars_.count(path) > 0; }
  std::string text(const std::string& path) const {
    const auto found = scalars_.find(path);
    return found == scalars_.end() ? std::string() : found->second;
  }
  /// NaN when there is none. Never by the locale: where the comma is the decimal sign, strtod reads
  /// 38.172 as 38.
  double number(const std::string& path) const {
    double out = 0.0;
#if defined(__cpp_lib_to_chars)
    const bool whole = read(text(path), out);
#else
    std::istringstream in(text(path));
    in.imbue(std::locale::classic());
    const bool whole = (in >> out) && in.peek() == std::istringstream::traits_type::eof();
#endif
    return whole ? out : std::nan("");
  }
  /// False, and `out` untouched, when it is no whole number or does not fit.
  template <typename Integer>
  bool integer(const std::string& path, Integer& out) const {
    return read(text(path), out);
  }

 private:
  template <typename Number>
  static bool read(const std::string& digits, Number& out) {
    Number found{};
    const char* const last = digits.data() + digits.size();
    const auto [end, error] = std::from_chars(digits.data(), last, found);
    if (error != std::errc{} || end != last) return false;
    out = found;
    return true;
  }
  void skip() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }
  bool take(char c) {
    skip();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  bool string(std::string& out) {
    if (!take('"')) return false;
    for (; at_ < text_.size() && text_[at_] != '"'; ++at_) {
      if (text_[at_] != '\\') {
        out += text_[at_];
      } else if (++at_ >= text_.size() || !escaped(out)) {
        return false;
      }
    }
    return take('"');
  }
  // What stands behind a backslash. lilod sends ASCII; beyond it, a question mark.
  bool escaped(std::string& out) {
    const char c = text_[at_];
    if (c == 'u') {
      unsigned code = 0;
      const char* const begin = text_.data() + at_ + 1;
      if (text_.size() - at_ < 5 || std::from_chars(begin, begin + 4, code, 16).ptr != begin + 4)
        return false;
      at_ += 4;
      out += code < 0x80 ? static_cast<char>(code) : '?';
      return true;
    }
    const std::string names = "\"\\/bfnrt", values = "\"\\/\b\f\n\r\t";
    const std::size_t k = names.find(c);
    if (k == std::string::npos) return false;
    out += values[k];
    return true;
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
    at_ = std::min(text_.find_first_not_of("+-.0123456789abcdefghijklmnopqrstuvwxyzE", at_),
                   text_.size());
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
  /// The major version of the protocol this client reads.
  static constexpr unsigned kProtocolMajor = 2;

  /// `host`: a name, or an IPv4 or IPv6 address. Throws std::system_error when there is no socket
  /// to be had, std::runtime_error when nobody has that name.
  explicit Client(const std::string& host = "127.0.0.1", std::uint16_t port = 9871)
      : server_(host + ':' + std::to_string(port)) {
    open(host, port);
  }
  ~Client() {
    request("\"unsubscribe\":{}");
    close(socket_);
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Waits for the next pose. False when none came in time, or at once when lilod speaks another
  /// version: why() then says which.
  bool next(ClientPose& pose, std::chrono::milliseconds timeout = std::chrono::seconds(10)) {
    const auto deadline = Clock::now() + timeout;
    heard_.clear();
    do {
      if (Clock::now() >= renew_at_) renew();
      if (!wait(deadline)) continue;
      std::array<char, 2048> bytes{};
      const ssize_t size = recv(socket_, bytes.data(), bytes.size(), 0);
      if (size < 0) {
        if (errno != EINTR && errno != EAGAIN) heard_ = system_error_text(errno);
      } else if (take(std::string(bytes.data(), static_cast<std::size_t>(size)), pose)) {
        why_.clear();
        return true;
      }
    } while (!other_version_ && Clock::now() < deadline);
    why_ = other_version_
               ? heard_
               : "no pose from lilod at " + server_ + " within " + std::to_string(timeout.count()) +
                     " ms: " + (heard_.empty() ? "no answer" : heard_);
    return false;
  }

  /// Why next() returned false last, in one line for people.
  const std::string& why() const { return why_; }

  /// The body of any request of the protocol: request("\"reset\":{}").
  void request(const std::string& body) {
    std::string text = '{' + body + (token_.empty() ? "" : ",\"token\":\"" + token_ + '"') + '}';
    // Until we have shown a token, lilod's answer is no longer than what we send.
    if (text.size() < kRequestBytes) text.resize(kRequestBytes, ' ');
    if (send(socket_, text.data(), text.size(), MSG_NOSIGNAL) < 0)
      heard_ = system_error_text(errno);  // the lease is asked for again
  }

 private:
  static constexpr std::size_t kRequestBytes = 256;
  using Clock = std::chrono::steady_clock;

  static std::string system_error_text(int error) {
    return error == ECONNREFUSED ? "nobody listens there" : std::generic_category().message(error);
  }

  void open(const std::string& host, std::uint16_t port) {
    addrinfo hints{};
    hints.ai_socktype = SOCK_DGRAM;
    addrinfo* found = nullptr;
    const int failure = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
    if (failure != 0)
      throw std::runtime_error("lilod at " + server_ + ": " + gai_strerror(failure));
    int error = 0;
    for (const addrinfo* a = found; a != nullptr && socket_ < 0; a = a->ai_next) {
      const int candidate = socket(a->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
      if (candidate >= 0 && connect(candidate, a->ai_addr, a->ai_addrlen) == 0) {
        socket_ = candidate;
      } else {
        error = errno;
        if (candidate >= 0) close(candidate);
      }
    }
    freeaddrinfo(found);
    if (socket_ < 0) throw std::system_error(error, std::generic_category(), "lilod at " + server_);
  }

  void renew() {
    renew_at_ = Clock::now() + std::chrono::seconds(1);
    request("\"subscribe\":{\"ttl_s\":5}");
  }

  // Until there is a datagram, the lease is to be renewed, or the time is over.
  bool wait(Clock::time_point deadline) {
    using std::chrono::ceil;
    using std::chrono::milliseconds;
    const auto left = ceil<milliseconds>(std::min(deadline, renew_at_) - Clock::now()).count();
    pollfd ready{socket_, POLLIN, 0};
    return poll(&ready, 1, static_cast<int>(std::max<long long>(left, 0))) > 0;
  }

  // Members with names of one letter, or items of an array. Whether all are numbers.
  template <std::size_t N>
  static bool read(const FlatJson& message, const std::string& path, std::array<double, N>& out,
                   const char* names = nullptr) {
    for (std::size_t k = 0; k < N; ++k) {
      std::string at = path + '/';
      at += names != nullptr ? std::string(1, names[k]) : std::to_string(k);
      out[k] = message.number(at);
    }
    return std::all_of(out.begin(), out.end(), [](double v) { return std::isfinite(v); });
  }

  bool take(const std::string& datagram, ClientPose& pose) {
    const FlatJson message(datagram);
    if (!message.good()) {
      heard_ = "what it sends is no JSON";
      return false;
    }
    const std::string version = message.text("v"), ours = std::to_string(kProtocolMajor);
    other_version_ = version.substr(0, version.find('.')) != ours;
    if (other_version_) {
      heard_ = "lilod at " + server_ + " speaks protocol " + version + ", this client reads " +
               ours + ".x";
      return false;
    }
    if (message.has("pose/status")) return take_pose(message, pose);
    if (message.has("hello/token")) {  // we are not on its computer: show that we got this
      token_ = message.text("hello/token");
      renew_at_ = {};
    } else if (message.has("error/reason")) {
      heard_ = "it refuses: " + message.text("error/reason");
    } else if (message.has("health/status")) {
      heard_ = "its health is " + message.text("health/status");
    } else if (message.has("hello/ttl_s")) {
      heard_ = "it has granted the subscription";
    }
    return false;
  }

  // A pose of which a number is missing is none.
  bool take_pose(const FlatJson& message, ClientPose& out) {
    ClientPose pose;
    std::int64_t sec = 0, nsec = 0;
    const bool whole = message.integer("seq", pose.seq) && message.integer("pose/stamp/sec", sec) &&
                       message.integer("pose/stamp/nsec", nsec) &&
                       read(message, "pose/position", pose.position, "xyz") &&
                       read(message, "pose/orientation", pose.orientation, "xyzw");
    if (!whole) {
      heard_ = "it sent a pose with numbers missing";
      return false;
    }
    pose.stamp_ns = sec * 1'000'000'000 + nsec;
    pose.timestamp = message.number("timestamp");
    pose.session = message.text("session");
    pose.new_session = pose.session != session_;
    session_ = pose.session;
    pose.frame_id = message.text("pose/frame_id");
    pose.child_frame_id = message.text("pose/child_frame_id");
    pose.status = message.text("pose/status");
    pose.latency_ms = message.number("pose/latency_ms");
    pose.has_twist = read(message, "pose/twist/linear", pose.linear, "xyz") &&
                     read(message, "pose/twist/angular", pose.angular, "xyz");
    if (!pose.has_twist) pose.linear = pose.angular = {};
    pose.has_covariance = read(message, "pose/covariance", pose.covariance);
    if (!pose.has_covariance) pose.covariance = {};
    read_weak_directions(message, pose);
    out = std::move(pose);
    return true;
  }

  static void read_weak_directions(const FlatJson& message, ClientPose& pose) {
    for (std::string weak = "pose/weak_directions/0"; message.has(weak + "/from_scan");
         weak = "pose/weak_directions/" + std::to_string(pose.weak_directions.size())) {
      ClientWeakDirection& added = pose.weak_directions.emplace_back();
      added.from_scan = message.number(weak + "/from_scan");
      read(message, weak + "/direction", added.direction);
    }
  }

  std::string server_;
  int socket_ = -1;
  std::string token_, session_;
  std::string heard_, why_;  // the last that was heard other than a pose; why next() gave up
  bool other_version_ = false;
  Clock::time_point renew_at_{};
};

}  // namespace lilo
