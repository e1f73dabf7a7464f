#pragma once

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

}  // namespace lilo
