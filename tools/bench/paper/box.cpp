// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/paper/box.hpp"

#include <algorithm>
#include <numeric>

namespace lilo::paper_bench {

double quantile(const std::vector<double>& sorted, double part) {
  const double at = part * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double s = at - static_cast<double>(below);
  return sorted[below] + s * (sorted[above] - sorted[below]);
}

Box box_of(std::vector<double> samples) {
  std::sort(samples.begin(), samples.end());
  Box box{.q1 = quantile(samples, 0.25),
          .median = quantile(samples, 0.5),
          .q3 = quantile(samples, 0.75)};
  box.mean =
      std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
  const double reach = 1.5 * (box.q3 - box.q1);
  box.low = box.q1, box.high = box.q3;
  for (const double sample : samples) {
    if (sample < box.q1 - reach || sample > box.q3 + reach) {
      box.outliers.push_back(sample);
    } else {
      box.low = std::min(box.low, sample);
      box.high = std::max(box.high, sample);
    }
  }
  return box;
}

}  // namespace lilo::paper_bench
