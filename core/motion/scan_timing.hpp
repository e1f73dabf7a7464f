// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/constants.hpp"

#include <cstdint>
#include <cstdlib>

namespace lilo::core {

/// When a scan was measured: its first and its last firing.
struct ScanTiming {
  std::int64_t start_ns = 0, end_ns = 0;
  bool motion_compensated = false;  ///< as in Scan

  /// From the first to the last firing; motion::kNominalSpan_s where the stamps tell none.
  [[nodiscard]] double span_s() const {
    const double span_s = 1e-9 * static_cast<double>(end_ns - start_ns);
    return span_s > 0.0 ? span_s : motion::kNominalSpan_s;
  }
  /// Whether no firing is missing between a scan that ended at `previous_end_ns` and this one.
  [[nodiscard]] bool follows(std::int64_t previous_end_ns) const {
    return std::abs(start_ns - previous_end_ns) < motion::kNextFiring_ns;
  }
};

inline double seconds_between(std::int64_t from_ns, std::int64_t to_ns) {
  return 1e-9 * static_cast<double>(to_ns - from_ns);
}

}  // namespace lilo::core
