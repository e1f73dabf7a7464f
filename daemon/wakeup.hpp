// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace lilo {

/// One thread tells another that there is something to do, through an eventfd: no lock, no
/// spinning, one system call a scan. Signals that come before wait() are not lost; several count as
/// one.
class Wakeup {
 public:
  enum class Mode { blocking, polled };  ///< polled: an event loop watches fd()

  /// Throws std::system_error when the system has no file descriptor left.
  explicit Wakeup(Mode mode);
  ~Wakeup();
  Wakeup(const Wakeup&) = delete;
  Wakeup& operator=(const Wakeup&) = delete;

  void signal() noexcept;
  /// Blocking: sleeps until the next signal. Polled: takes the signals that are there.
  void wait() noexcept;
  [[nodiscard]] int fd() const { return fd_; }

 private:
  int fd_;
};

}  // namespace lilo
