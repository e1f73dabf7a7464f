// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/health.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace lilo {

/// Totals as they were, second by second, for what happened lately. Fixed memory, one thread.
class RecentFaults {
 public:
  static constexpr std::int64_t kSeconds = 10;

  /// What was added to `totals` in the last ten seconds, give or take one. A total that fell (a
  /// packet taken for lost that came late) adds nothing.
  FaultCounts see(const FaultCounts& totals, std::int64_t now_ns) {
    if (next_ == 0 || now_ns - noted_ns_ >= kNoteEveryNs) {
      notes_[next_++ % notes_.size()] = totals;
      noted_ns_ = now_ns;
    }
    const FaultCounts& before = notes_[next_ % notes_.size()];  // the oldest
    FaultCounts out;
    for (std::size_t k = 0; k < kFaultCount; ++k)
      out.counts[k] = totals.counts[k] - std::min(totals.counts[k], before.counts[k]);
    return out;
  }

 private:
  static constexpr std::int64_t kNoteEveryNs = 950'000'000;  // a timer of 1 s may come early
  std::array<FaultCounts, kSeconds + 1> notes_{};            // zeros: of before the start
  std::int64_t noted_ns_ = 0;
  std::size_t next_ = 0;
};

}  // namespace lilo
