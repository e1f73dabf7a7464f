// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/metrics_file.hpp"
#include "daemon/wakeup.hpp"

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>

namespace lilo {

/// Replaces a file with every text it is given, on a thread of its own and of normal policy: a busy
/// disk delays no pose. One thread calls; it never waits, and once warm it does not allocate.
class MetricsWriter {
 public:
  using Replace = std::error_code (*)(const std::string& path, std::string_view text);

  /// Throws std::system_error when the system has no file descriptor left. `replace`: for tests,
  /// what writes a file. `longest_write`: a disk that takes longer has stalled.
  explicit MetricsWriter(
      Replace replace = replace_file,
      std::chrono::steady_clock::duration longest_write = std::chrono::seconds(5))
      : replace_(replace), longest_write_(longest_write) {}
  /// Waits until what it was given is written.
  ~MetricsWriter();
  MetricsWriter(const MetricsWriter&) = delete;
  MetricsWriter& operator=(const MetricsWriter&) = delete;

  /// An empty path: there is no file. While the text before is still being written, this one is
  /// left out, and it is an error (device_or_resource_busy) when that takes too long. Returns why
  /// the last text could not be written, or nothing. The first call with a file starts the thread,
  /// so that it comes after the process has its memory locked and its stacks limited, and throws
  /// std::system_error when there is none.
  std::error_code write(const std::string& path, std::string_view text);

 private:
  void run();

  Wakeup given_{Wakeup::Mode::blocking};
  std::atomic<bool> stop_{false};
  std::chrono::steady_clock::time_point given_at_;  // the caller's
  /// Whose the three below are: the thread's while it is set, else the caller's.
  std::atomic<bool> writing_{false};
  std::string path_, text_;
  std::error_code error_;
  Replace replace_;
  std::chrono::steady_clock::duration longest_write_;
  std::thread thread_;
};

}  // namespace lilo
