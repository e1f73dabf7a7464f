// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/metrics_writer.hpp"

#include "daemon/realtime.hpp"

#include <pthread.h>

namespace lilo {

MetricsWriter::~MetricsWriter() {
  if (!thread_.joinable()) return;
  stop_ = true;
  given_.signal();
  thread_.join();
}

std::error_code MetricsWriter::write(const std::string& path, std::string_view text) {
  if (path.empty()) return {};
  if (writing_.load(std::memory_order_acquire)) {
    const bool stalled = std::chrono::steady_clock::now() - given_at_ >= longest_write_;
    return stalled ? std::make_error_code(std::errc::device_or_resource_busy) : std::error_code();
  }
  given_at_ = std::chrono::steady_clock::now();
  const std::error_code error = error_;
  if (!thread_.joinable()) text_.reserve(2 * text.size());  // its numbers grow longer
  path_ = path;
  text_ = text;
  writing_.store(true, std::memory_order_release);
  given_.signal();
  if (!thread_.joinable()) thread_ = std::thread(&MetricsWriter::run, this);
  return error;
}

void MetricsWriter::run() {
  pthread_setname_np(pthread_self(), "lilo-metrics");
  use_normal_policy_in_this_thread();  // not the publisher's, which it would inherit
  for (bool last = false; !last;) {
    given_.wait();
    last = stop_;  // asked first: what was given before the end is written
    if (!writing_.load(std::memory_order_acquire)) continue;
    error_ = replace_(path_, text_);
    writing_.store(false, std::memory_order_release);
  }
}

}  // namespace lilo
