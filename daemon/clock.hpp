// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <ctime>

namespace lilo {

inline std::int64_t clock_ns(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

/// For durations: never steps.
inline std::int64_t monotonic_ns() { return clock_ns(CLOCK_MONOTONIC); }
/// UTC, for stamps alone: may step.
inline std::int64_t realtime_ns() { return clock_ns(CLOCK_REALTIME); }

}  // namespace lilo
