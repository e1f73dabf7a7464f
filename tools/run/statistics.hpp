// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

namespace lilo {

/// Of a set of measurements; all 0 of an empty one.
struct Statistics {
  double mean = 0.0;
  double p50 = 0.0;  ///< the smallest value that half of all do not exceed
  double p99 = 0.0;
  double max = 0.0;
};

Statistics statistics(std::vector<double> values);

/// Means of the first tenth of the values, the second, and so on, for what may grow with time; all
/// 0 of fewer than ten.
std::array<double, 10> means_of_tenths(const std::vector<double>& values);

}  // namespace lilo
