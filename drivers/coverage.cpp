// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/coverage.hpp"

namespace lilo {

Coverage::Hole Coverage::largest_hole() const {
  std::size_t best_start = 0, best_width = 0, width = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    width = bins_[i] ? 0 : width + 1;
    if (width > best_width) {
      best_width = width;
      best_start = i + 1 - width;
    }
  }
  return {static_cast<double>(best_start) * kTicksPerBin,
          static_cast<double>(best_width) * kTicksPerBin};
}

}  // namespace lilo
