// SPDX-License-Identifier: BSD-3-Clause
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <dlfcn.h>
#include <sys/socket.h>
#include <unistd.h>

/// For LD_PRELOAD: a computer on which something is broken.
/// BROKEN_NETWORK_FILE: while that file exists, recvmmsg(2) fails as it does for a card that is
/// down. STALLED_FILE: rename(2) of a file with that in its name never ends, as on a disk that is
/// gone.
namespace {

const char* variable(const char* name) {
  return std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
}

template <typename Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

// NOLINTNEXTLINE(readability-inconsistent-declaration-parameter-name)
int recvmmsg(int fd, mmsghdr* messages, unsigned count, int flags, timespec* timeout) {
  static const auto real = next<int (*)(int, mmsghdr*, unsigned, int, timespec*)>("recvmmsg");
  static const char* const file = variable("BROKEN_NETWORK_FILE");
  if (file == nullptr || access(file, F_OK) != 0) return real(fd, messages, count, flags, timeout);
  errno = ENETDOWN;
  return -1;
}

// NOLINTNEXTLINE(readability-inconsistent-declaration-parameter-name)
int rename(const char* from, const char* to) noexcept {
  static const auto real = next<int (*)(const char*, const char*)>("rename");
  static const char* const stalled = variable("STALLED_FILE");
  while (stalled != nullptr && std::strstr(to, stalled) != nullptr) pause();
  return real(from, to);
}
}
