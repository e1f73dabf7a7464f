// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace lilo::worlds {

/// Of the values that several seeds brought.
struct Spread {
  int count = 0;  ///< known values
  double mean = 0.0;
  double deviation = 0.0;  ///< of the sample, over count - 1; 0 of a single value
};

/// NaNs are left out.
Spread spread_of(const std::vector<double>& values);

/// Of two variants over the same seeds.
struct Difference {
  int count = 0;  ///< seeds where both values are known
  double mean = 0.0;
  double standard_error = 0.0;  ///< of the mean; 0 of a single seed
  /// |mean| > 2 standard_error, with two seeds or more. Chance alone brings that in 30 % of cases
  /// with two seeds, 18 % with three, 12 % with five (Student's t): look at the direction over
  /// worlds as well.
  bool beyond_spread = false;
};

/// Second minus first, seed by seed; the vectors have one length.
Difference difference_of(const std::vector<double>& first, const std::vector<double>& second);

}  // namespace lilo::worlds
