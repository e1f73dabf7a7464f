// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/wakeup.hpp"

#include <cerrno>
#include <cstdint>
#include <sys/eventfd.h>
#include <system_error>
#include <unistd.h>

namespace lilo {

Wakeup::Wakeup(Mode mode)
    : fd_(eventfd(0, EFD_CLOEXEC | (mode == Mode::polled ? EFD_NONBLOCK : 0))) {
  if (fd_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

Wakeup::~Wakeup() { close(fd_); }

void Wakeup::signal() noexcept {
  const std::uint64_t one = 1;
  // It can fail only when the counter is full, and then the other side has been told already.
  [[maybe_unused]] const auto written = write(fd_, &one, sizeof(one));
}

void Wakeup::wait() noexcept {
  std::uint64_t count = 0;
  while (read(fd_, &count, sizeof(count)) < 0 && errno == EINTR) {
  }
}

}  // namespace lilo
