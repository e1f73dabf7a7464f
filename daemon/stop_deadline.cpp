// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/stop_deadline.hpp"

#include <csignal>
#include <string_view>
#include <unistd.h>

namespace lilo {
namespace {

// In a signal handler: nothing but what signal-safety(7) allows.
void end_now(int) {
  constexpr std::string_view kText =
      "<3>lilod: a thread did not end in time after the signal to stop: ending without it\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kText.data(), kText.size());
  _exit(1);
}

}  // namespace

void start_stop_deadline(unsigned seconds) {
  struct sigaction action {};
  action.sa_handler = end_now;
  sigaction(SIGALRM, &action, nullptr);
  alarm(seconds);
}

}  // namespace lilo
