// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/wire.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <span>
#include <vector>

/// Angles around the sensor. On the wire and in the assembly they are ticks of 0.01 degree,
/// clockwise; in a Return they are radians, counter-clockwise from +x (REP-103).
namespace lilo {

/// Into [0, 36000).
inline double wrap_ticks(double ticks) {
  const double turns = std::floor(ticks / wire::kTicksPerTurn);
  const double wrapped = ticks - turns * wire::kTicksPerTurn;
  return wrapped < wire::kTicksPerTurn ? wrapped : 0.0;  // -1e-20 would round up to a full turn
}

/// The short way from one azimuth to another, in [-18000, 18000).
inline int short_way_ticks(int from, int to) {
  const int half = wire::kTicksPerTurn / 2;
  return (to - from + wire::kTicksPerTurn + half) % wire::kTicksPerTurn - half;
}

/// The step of the head from shot to shot in a packet. The encoder's noise is one tick and the head
/// cannot change its speed within a packet, so the mean is better than any single step; the median
/// stands in where one step is far larger, as of a sensor that does not fire in a part of its turn.
/// Reorders `steps`, which must not be empty.
inline double typical_step(std::span<int> steps) {
  int sum = 0, largest = 0;
  for (const int step : steps) {
    sum += step;
    largest = std::max(largest, std::abs(step));
  }
  const double mean = static_cast<double>(sum) / static_cast<double>(steps.size());
  if (largest <= 2.0 * std::abs(mean) + 4.0) return mean;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// Counter-clockwise radians in [-pi, pi) from clockwise ticks.
inline float ccw_rad_from_ticks(double ticks) {
  const double cw = wrap_ticks(ticks) * wire::kRadPerTick;  // [0, 2 pi)
  return static_cast<float>(cw <= std::numbers::pi ? -cw : 2.0 * std::numbers::pi - cw);
}

/// Into [-pi, pi), from less than a turn outside.
inline float wrap_rad(float rad) {
  constexpr float kPi = std::numbers::pi_v<float>;
  const float more = rad + 2.0F * kPi, less = rad - 2.0F * kPi;  // before asking: no branch
  return rad < -kPi ? more : (rad >= kPi ? less : rad);
}

/// Each into [-pi, pi). None is farther than `most_rad` from `about_rad`, so mostly none is
/// outside.
inline void wrap_around(float about_rad, float most_rad, std::span<float> azimuths_rad) {
  constexpr float kNearPi = 3.14F;  // room for rounding
  if (std::abs(about_rad) + most_rad < kNearPi) return;
  for (float& rad : azimuths_rad) rad = wrap_rad(rad);
}

/// Cosine, sine and counter-clockwise angle of each of the 36000 azimuths a packet can name.
class AzimuthTable {
 public:
  struct Entry {
    float cos, sin, ccw_rad;
  };
  AzimuthTable() : entries_(wire::kTicksPerTurn) {
    for (int i = 0; i < wire::kTicksPerTurn; ++i) {
      const double a = i * wire::kRadPerTick;
      entries_[static_cast<std::size_t>(i)] = {static_cast<float>(std::cos(a)),
                                               static_cast<float>(std::sin(a)),
                                               ccw_rad_from_ticks(static_cast<double>(i))};
    }
  }
  /// `ticks` in [0, 36000).
  [[nodiscard]] const Entry& operator[](int ticks) const {
    return entries_[static_cast<std::size_t>(ticks)];
  }

 private:
  std::vector<Entry> entries_;
};

}  // namespace lilo
