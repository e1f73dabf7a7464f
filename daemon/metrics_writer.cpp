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

bool MetricsWriter::write(const ReplacedFile& file, std::string_view text) {
  if (file.is_none() || writing_.load(std::memory_order_acquire)) return true;
  const bool written = written_;
  if (!thread_.joinable()) text_.reserve(2 * text.size());  // its numbers grow longer
  file_ = file;
  text_ = text;
  writing_.store(true, std::memory_order_release);
  given_.signal();
  if (!thread_.joinable()) thread_ = std::thread(&MetricsWriter::run, this);
  return written;
}

void MetricsWriter::run() {
  pthread_setname_np(pthread_self(), "lilo-metrics");
  use_normal_policy_in_this_thread();  // not the publisher's, which it would inherit
  for (bool last = false; !last;) {
    given_.wait();
    last = stop_;  // asked first: what was given before the end is written
    if (!writing_.load(std::memory_order_acquire)) continue;
    written_ = file_.write(text_);
    writing_.store(false, std::memory_order_release);
  }
}

}  // namespace lilo
