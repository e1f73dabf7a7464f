// SPDX-License-Identifier: BSD-3-Clause
#include "tools/run/stage_timer.hpp"

#include "tools/clock.hpp"

namespace lilo {

double StageTimer::lap_ms() {
  const std::int64_t now_ns = thread_cpu_ns();
  const double lap = static_cast<double>(now_ns - lap_start_ns_) * 1e-6;
  lap_start_ns_ = now_ns;
  return lap;
}

void StageTimer::start() {
  scan_start_ns_ = lap_start_ns_ = thread_cpu_ns();
  stage_now_ms_.fill(0.0);
}

void StageTimer::decoded() { decode_now_ms_ = lap_ms(); }

StageHook StageTimer::hook() {
  const auto done = [](void* context, Stage stage) {
    auto& timer = *static_cast<StageTimer*>(context);
    timer.stage_now_ms_[static_cast<std::size_t>(stage)] += timer.lap_ms();
  };
  return {done, this};
}

void StageTimer::finish() {
  total_ms_.push_back(static_cast<double>(thread_cpu_ns() - scan_start_ns_) * 1e-6);
  decode_ms_.push_back(decode_now_ms_);
  for (std::size_t k = 0; k < stage_ms_.size(); ++k) stage_ms_[k].push_back(stage_now_ms_[k]);
  start();
}

}  // namespace lilo
