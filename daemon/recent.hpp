// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace lilo {

struct Quantiles {
  double p50 = 0.0, p99 = 0.0, max = 0.0;
};

/// The last values of a series, for their quantiles. Fixed memory, one thread.
class RecentValues {
 public:
  static constexpr std::size_t kCapacity = 600;  ///< a minute of scans at 10 Hz

  void add(double value) { values_[count_++ % kCapacity] = value; }

  /// Nearest-rank quantiles; zeros when there is no value yet.
  [[nodiscard]] Quantiles quantiles() const {
    const std::size_t n = std::min(count_, kCapacity);
    if (n == 0) return {};
    std::array<double, kCapacity> sorted = values_;
    std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(n));
    const auto rank = [&](double q) {
      const auto position = static_cast<std::size_t>(q * static_cast<double>(n) + 0.999999);
      return sorted[std::clamp<std::size_t>(position, 1, n) - 1];
    };
    return {.p50 = rank(0.50), .p99 = rank(0.99), .max = sorted[n - 1]};
  }

 private:
  std::array<double, kCapacity> values_{};
  std::size_t count_ = 0;
};

}  // namespace lilo
