// SPDX-License-Identifier: BSD-3-Clause
#include "tools/run/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace lilo {

Statistics statistics(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto count = static_cast<double>(values.size());
  const auto percentile = [&](double part) {
    return values[static_cast<std::size_t>(std::ceil(part * count)) - 1];
  };
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return {
      .mean = sum / count, .p50 = percentile(0.5), .p99 = percentile(0.99), .max = values.back()};
}

std::array<double, 10> means_of_tenths(const std::vector<double>& values) {
  std::array<double, 10> means{};
  if (values.size() < means.size()) return means;
  const auto at = [&](std::size_t k) {
    return values.begin() + static_cast<std::ptrdiff_t>(k * values.size() / means.size());
  };
  for (std::size_t k = 0; k < means.size(); ++k) {
    const auto count = static_cast<double>(at(k + 1) - at(k));
    means[k] = std::accumulate(at(k), at(k + 1), 0.0) / count;
  }
  return means;
}

}  // namespace lilo
