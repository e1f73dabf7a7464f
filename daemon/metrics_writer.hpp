// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/metrics_file.hpp"
#include "daemon/wakeup.hpp"

#include <atomic>
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

  static constexpr int kMostLeftOut = 4;  ///< the publisher gives one text a second

  /// Throws std::system_error when the system has no file descriptor left. `replace`: for tests,
  /// what writes a file.
  explicit MetricsWriter(Replace replace = replace_file) : replace_(replace) {}
  /// Waits until what it was given is written.
  ~MetricsWriter();
  MetricsWriter(const MetricsWriter&) = delete;
  MetricsWriter& operator=(const MetricsWriter&) = delete;

  /// An empty path: there is no file. While the text before is still being written, this one is
  /// left out, and more than kMostLeftOut in a row are an error (device_or_resource_busy). Why the
  /// last one could not be written, or nothing. The first call with a file starts
  /// the thread, so that it comes after the process has its memory locked and its stacks limited,
  /// and throws std::system_error when there is none.
  std::error_code write(const std::string& path, std::string_view text);

 private:
  void run();

  Wakeup given_{Wakeup::Mode::blocking};
  std::atomic<bool> stop_{false};
  int left_out_ = 0;  // in a row; the caller's
  /// Whose the three below are: the thread's while it is set, else the caller's.
  std::atomic<bool> writing_{false};
  std::string path_, text_;
  std::error_code error_;
  Replace replace_;
  std::thread thread_;
};

}  // namespace lilo
