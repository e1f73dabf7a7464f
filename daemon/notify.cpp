// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/notify.hpp"

#include "daemon/clock.hpp"

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <sys/socket.h>
#include <sys/uio.h>
#include <sys/un.h>
#include <unistd.h>

namespace lilo::notify {
namespace {

// The environment is read on the main thread only, and nothing writes it.
std::string_view environment(const char* name) {
  const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
  return value == nullptr ? std::string_view() : std::string_view(value);
}

std::int64_t number(std::string_view text) {
  std::int64_t value = 0;
  std::from_chars(text.begin(), text.end(), value);
  return value;
}

// The protocol is one datagram of NAME=value lines to a Unix socket, whose name may start with '@'
// for the abstract namespace.
void send(std::string_view assignment, std::string_view text, int flags) {
  const std::string_view path = environment("NOTIFY_SOCKET");
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() < 2 || path.size() >= sizeof(address.sun_path)) return;
  std::memcpy(address.sun_path, path.data(), path.size());
  if (path[0] == '@') address.sun_path[0] = '\0';
  const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return;
  // sendmsg(2) only reads what it is given, whatever its type says.
  std::array<iovec, 2> parts{{{const_cast<char*>(assignment.data()), assignment.size()},
                              {const_cast<char*>(text.data()), text.size()}}};
  msghdr message{};
  message.msg_name = &address;
  message.msg_namelen = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size());
  message.msg_iov = parts.data();
  message.msg_iovlen = parts.size();
  sendmsg(fd, &message, flags | MSG_NOSIGNAL);
  close(fd);
}

}  // namespace

void ready(std::string_view status) { send("READY=1\nSTATUS=", status, 0); }

void status(std::string_view status) { send("STATUS=", status, MSG_DONTWAIT); }

void reloading() {
  send("RELOADING=1\nMONOTONIC_USEC=", std::to_string(monotonic_ns() / 1000), MSG_DONTWAIT);
}

void stopping() { send("STOPPING=1", "", MSG_DONTWAIT); }

void watchdog() { send("WATCHDOG=1", "", MSG_DONTWAIT); }

std::int64_t watchdog_interval_us() {
  const std::string_view pid = environment("WATCHDOG_PID");
  if (!pid.empty() && number(pid) != getpid()) return 0;
  return number(environment("WATCHDOG_USEC"));
}

}  // namespace lilo::notify
