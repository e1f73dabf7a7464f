// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/random.hpp"

#include <algorithm>
#include <cmath>

namespace lilo::sim {

SinCos sin_cos(double x) {
  // pi/2 in two parts, so that the reduction keeps its digits.
  constexpr double kHalfPiHigh = 0x1.921FB54400000p+0;
  constexpr double kHalfPiLow = 0x1.0B4611A626331p-34;
  const double quarter = std::floor(x * (2.0 / std::numbers::pi) + 0.5);
  const double r = (x - quarter * kHalfPiHigh) - quarter * kHalfPiLow;
  const double r2 = r * r;
  const double s =
      r * (1.0 + r2 * (-1.0 / 6 +
                       r2 * (1.0 / 120 +
                             r2 * (-1.0 / 5040 +
                                   r2 * (1.0 / 362880 +
                                         r2 * (-1.0 / 39916800 +
                                               r2 * (1.0 / 6227020800 - r2 / 1307674368000.0)))))));
  const double c =
      1.0 +
      r2 * (-0.5 + r2 * (1.0 / 24 +
                         r2 * (-1.0 / 720 +
                               r2 * (1.0 / 40320 + r2 * (-1.0 / 3628800 +
                                                         r2 * (1.0 / 479001600 -
                                                               r2 * (1.0 / 87178291200.0 -
                                                                     r2 / 20922789888000.0)))))));
  switch (static_cast<std::int64_t>(quarter) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

double smoothstep(double edge0, double edge1, double x) {
  const double s = std::clamp((x - edge0) / (edge1 - edge0), 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

}  // namespace lilo::sim
