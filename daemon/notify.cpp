#include "daemon/notify.hpp"

#include "daemon/clock.hpp"

#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <sys/socket.h>
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
void send(const std::string& text, int flags) {
  const std::string_view path = environment("NOTIFY_SOCKET");
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() < 2 || path.size() >= sizeof(address.sun_path)) return;
  std::memcpy(address.sun_path, path.data(), path.size());
  if (path[0] == '@') address.sun_path[0] = '\0';
  const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return;
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size());
  sendto(fd, text.data(), text.size(), flags | MSG_NOSIGNAL,
         reinterpret_cast<const sockaddr*>(&address), size);
  close(fd);
}

}  // namespace

void ready(const std::string& status) { send("READY=1\nSTATUS=" + status, 0); }

void status(const std::string& status) { send("STATUS=" + status, MSG_DONTWAIT); }

void reloading() {
  send("RELOADING=1\nMONOTONIC_USEC=" + std::to_string(monotonic_ns() / 1000), MSG_DONTWAIT);
}

void stopping() { send("STOPPING=1", MSG_DONTWAIT); }

void watchdog() { send("WATCHDOG=1", MSG_DONTWAIT); }

std::int64_t watchdog_interval_us() {
  const std::string_view pid = environment("WATCHDOG_PID");
  if (!pid.empty() && number(pid) != getpid()) return 0;
  return number(environment("WATCHDOG_USEC"));
}

}  // namespace lilo::notify
