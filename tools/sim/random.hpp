// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>

/// Random numbers and elementary functions whose bits do not depend on the C++ library.
/// The standard leaves the distributions' algorithms and the last bit of std::sin open; a
/// simulation that must be the same everywhere cannot use them.
namespace lilo::sim {

/// SplitMix64 (Steele, Lea, Flood 2014): every seed gives a full-period, well-mixed stream.
class Random {
 public:
  /// Streams of one seed are independent: use one per purpose, so that a change to one piece of the
  /// world does not move the others.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0)
      : state_(mix(seed * 0x9E3779B97F4A7C15ULL + mix(stream + 0x632BE59BD9B4E019ULL))) {}

  std::uint64_t next() { return mix(state_ += 0x9E3779B97F4A7C15ULL); }

  /// In [0, 1).
  double uniform() { return static_cast<double>(next() >> 11U) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  bool chance(double probability) { return uniform() < probability; }
  int below(int n) { return static_cast<int>(uniform() * n); }
  double angle() { return uniform(-std::numbers::pi, std::numbers::pi); }

  /// Mean 0, sigma 1: the sum of twelve uniforms (Irwin-Hall), kurtosis 2.9, |value| < 6.
  double normal() {
    double sum = -6.0;
    for (int k = 0; k < 4; ++k) {
      const std::uint64_t bits = next();
      sum += static_cast<double>(bits & 0x1FFFFFU) * 0x1.0p-21;
      sum += static_cast<double>((bits >> 21U) & 0x1FFFFFU) * 0x1.0p-21;
      sum += static_cast<double>((bits >> 42U) & 0x1FFFFFU) * 0x1.0p-21;
    }
    return sum;
  }

  template <typename T, std::size_t N>
  const T& pick(const std::array<T, N>& from) {
    return from[static_cast<std::size_t>(below(static_cast<int>(N)))];
  }

  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
  }

 private:
  std::uint64_t state_;
};

struct SinCos {
  double sin, cos;
};

/// Taylor series on [-pi/4, pi/4] after reduction by quarter turns; error below 2e-16 for |x| <
/// 1e5.
SinCos sin_cos(double x);

/// 3 s^2 - 2 s^3 between the edges, 0 below, 1 above.
double smoothstep(double edge0, double edge1, double x);

}  // namespace lilo::sim
