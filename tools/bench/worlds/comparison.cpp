// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/worlds/comparison.hpp"

#include <cmath>
#include <cstddef>
#include <numeric>

namespace lilo::worlds {

Spread spread_of(const std::vector<double>& values) {
  std::vector<double> known;
  for (const double value : values) {
    if (!std::isnan(value)) known.push_back(value);
  }
  Spread spread{.count = static_cast<int>(known.size())};
  if (known.empty()) return spread;
  spread.mean = std::reduce(known.begin(), known.end()) / spread.count;
  if (spread.count == 1) return spread;
  double squares = 0.0;
  for (const double value : known) squares += (value - spread.mean) * (value - spread.mean);
  spread.deviation = std::sqrt(squares / (spread.count - 1));
  return spread;
}

Difference difference_of(const std::vector<double>& first, const std::vector<double>& second) {
  std::vector<double> differences;
  for (std::size_t k = 0; k < first.size(); ++k) differences.push_back(second[k] - first[k]);
  const Spread spread = spread_of(differences);
  if (spread.count == 0) return {};
  const double standard_error = spread.deviation / std::sqrt(spread.count);
  return {.count = spread.count,
          .mean = spread.mean,
          .standard_error = standard_error,
          .beyond_spread = spread.count > 1 && std::abs(spread.mean) > 2.0 * standard_error};
}

}  // namespace lilo::worlds
