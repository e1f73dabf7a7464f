// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>
#include <ctime>
#include <dlfcn.h>
#include <sys/socket.h>
#include <unistd.h>

/// For LD_PRELOAD: as soon as the file STEP_CLOCK_FILE exists, the computer's UTC is an hour ahead,
/// in clock_gettime() and in the kernel's stamps of received packets. Other clocks go on.
namespace {

constexpr time_t kStep_s = 3600;

bool stepped() {
  static const char* const file = std::getenv("STEP_CLOCK_FILE");  // NOLINT(concurrency-mt-unsafe)
  return file != nullptr && access(file, F_OK) == 0;
}

template <typename Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

void step(msghdr& message) {
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SCM_TIMESTAMPNS) continue;
    reinterpret_cast<timespec*>(CMSG_DATA(c))->tv_sec += kStep_s;
  }
}

}  // namespace

extern "C" {

// NOLINTNEXTLINE(readability-inconsistent-declaration-parameter-name)
int clock_gettime(clockid_t clock, timespec* tp) noexcept {
  static const auto real = next<int (*)(clockid_t, timespec*)>("clock_gettime");
  const int result = real(clock, tp);
  if (clock == CLOCK_REALTIME && stepped()) tp->tv_sec += kStep_s;
  return result;
}

// NOLINTNEXTLINE(readability-inconsistent-declaration-parameter-name)
int recvmmsg(int fd, mmsghdr* messages, unsigned count, int flags, timespec* timeout) {
  static const auto real = next<int (*)(int, mmsghdr*, unsigned, int, timespec*)>("recvmmsg");
  const int received = real(fd, messages, count, flags, timeout);
  if (received > 0 && stepped()) {
    for (int k = 0; k < received; ++k) step(messages[k].msg_hdr);
  }
  return received;
}
}
