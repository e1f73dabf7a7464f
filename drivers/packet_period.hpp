// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace lilo {

/// Measures the time between packets from their stamps: the median of ten steps, so that a few lost
/// or swapped packets do not matter.
class PacketPeriod {
 public:
  void see(std::int64_t stamp_ns) {
    if (started_ && stamp_ns > last_ns_) {
      steps_[count_ % kSteps] = stamp_ns - last_ns_;
      ++count_;
    }
    last_ns_ = stamp_ns;
    started_ = true;
  }
  /// 0 until enough was seen.
  [[nodiscard]] double median_ns() const {
    if (count_ < kSteps) return 0.0;
    std::array<std::int64_t, kSteps> sorted = steps_;
    std::sort(sorted.begin(), sorted.end());
    return static_cast<double>(sorted[kSteps / 2]);
  }
  void restart() { *this = PacketPeriod(); }

 private:
  static constexpr std::size_t kSteps = 10;
  bool started_ = false;
  std::int64_t last_ns_ = 0;
  std::array<std::int64_t, kSteps> steps_{};
  std::size_t count_ = 0;
};

}  // namespace lilo
