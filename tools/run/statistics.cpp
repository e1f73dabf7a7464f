#include "tools/run/statistics.hpp"

#include <algorithm>
#include <cmath>
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

}  // namespace lilo
