// SPDX-License-Identifier: BSD-3-Clause
#include "tests/daemon/sockets.hpp"

#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <ifaddrs.h>
#include <poll.h>
#include <stdexcept>
#include <sys/socket.h>
#include <sys/un.h>
#include <system_error>
#include <unistd.h>

namespace lilo {
namespace {

using Clock = std::chrono::steady_clock;

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}

void require(bool holds, const char* what) {
  if (!holds) throw std::system_error(errno, std::generic_category(), what);
}

std::optional<std::string> receive_from(int fd, std::chrono::milliseconds at_most,
                                        sockaddr_in* sender = nullptr) {
  pollfd poll_fd{.fd = fd, .events = POLLIN};
  if (poll(&poll_fd, 1, static_cast<int>(at_most.count())) <= 0) return std::nullopt;
  std::array<char, 65536> bytes{};
  socklen_t length = sender == nullptr ? 0 : sizeof(*sender);
  const ssize_t size = recvfrom(fd, bytes.data(), bytes.size(), 0,
                                reinterpret_cast<sockaddr*>(sender), sender ? &length : nullptr);
  if (size < 0) return std::nullopt;
  return std::string(bytes.data(), static_cast<std::size_t>(size));
}

}  // namespace

UdpSocket::UdpSocket() : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  require(fd_ >= 0, "socket");
  const int buffer_bytes = 4 << 20;
  setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &buffer_bytes, sizeof(buffer_bytes));
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof(address);
  require(bind(fd_, reinterpret_cast<sockaddr*>(&address), size) == 0, "bind");
  require(getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size) == 0, "getsockname");
  port_ = ntohs(address.sin_port);
}

UdpSocket::~UdpSocket() { close(fd_); }

std::optional<std::string> UdpSocket::receive(std::chrono::milliseconds at_most) {
  sockaddr_in sender{};
  auto datagram = receive_from(fd_, at_most, &sender);
  if (datagram) sender_ = ntohs(sender.sin_port);
  return datagram;
}

void UdpSocket::send_to(std::uint16_t port, const std::string& datagram) const {
  const sockaddr_in to = loopback(port);
  const ssize_t sent = sendto(fd_, datagram.data(), datagram.size(), 0,
                              reinterpret_cast<const sockaddr*>(&to), sizeof(to));
  require(sent == static_cast<ssize_t>(datagram.size()), "sendto");
}

std::uint16_t free_udp_port() {
  // The system gives ports of 32768 and more to sockets that ask for any. Programs that run at the
  // same time begin at other ports.
  constexpr int kFirst = 10000, kCount = 20000, kOfOneProgram = 50;
  static std::atomic<int> next{0};
  for (int tried = 0; tried < kCount; ++tried) {
    const int port = kFirst + (getpid() * kOfOneProgram + next++) % kCount;
    const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    require(fd >= 0, "socket");
    const sockaddr_in address = loopback(static_cast<std::uint16_t>(port));
    const bool is_free =
        bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
    close(fd);
    if (is_free) return static_cast<std::uint16_t>(port);
  }
  throw std::runtime_error("no UDP port is free");
}

std::optional<std::string> outer_address() {
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return std::nullopt;
  std::optional<std::string> out;
  for (const ifaddrs* each = all; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET) continue;
    const auto* address = reinterpret_cast<const sockaddr_in*>(each->ifa_addr);
    const std::string text = inet_ntoa(address->sin_addr);
    if (!text.starts_with("127.")) out = text;
  }
  freeifaddrs(all);
  return out;
}

NotifySocket::NotifySocket() : fd_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  static std::atomic<int> next{0};
  path_ = "/tmp/lilo_notify_" + std::to_string(getpid()) + '_' + std::to_string(next++);
  unlink(path_.c_str());
  require(fd_ >= 0, "socket");
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path_.c_str(), sizeof(address.sun_path) - 1);
  require(bind(fd_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0, "bind");
}

NotifySocket::~NotifySocket() {
  close(fd_);
  unlink(path_.c_str());
}

bool NotifySocket::wait_for(const std::string& text, std::chrono::milliseconds at_most) {
  const auto deadline = Clock::now() + at_most;
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) return false;
    const auto message = receive_from(fd_, left);
    if (!message) return false;
    log_ += *message + '\n';
    if (('\n' + *message).find('\n' + text) != std::string::npos) return true;
  }
}

}  // namespace lilo
