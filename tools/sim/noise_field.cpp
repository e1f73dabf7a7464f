// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/noise_field.hpp"

#include "tools/sim/random.hpp"

#include <cmath>

namespace lilo::sim {
namespace {

double corner(std::uint64_t seed, std::int64_t i, std::int64_t j, double dx, double dy) {
  const std::uint64_t h =
      Random::mix(seed ^ (static_cast<std::uint64_t>(i) * 0x8DA6B343ULL +
                          static_cast<std::uint64_t>(j) * 0xD8163841ULL * 0x9E3779B9ULL));
  // Gradient with both components uniform: not of unit length, which only makes it less regular.
  const double gx = static_cast<double>(h & 0xFFFFFFU) * 0x1.0p-23 - 1.0;
  const double gy = static_cast<double>((h >> 24U) & 0xFFFFFFU) * 0x1.0p-23 - 1.0;
  return gx * dx + gy * dy;
}

double fade(double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }

}  // namespace

double gradient_noise(std::uint64_t seed, double x, double y) {
  const double fx = std::floor(x), fy = std::floor(y);
  const auto i = static_cast<std::int64_t>(fx), j = static_cast<std::int64_t>(fy);
  const double dx = x - fx, dy = y - fy;
  const double u = fade(dx), v = fade(dy);
  const double bottom =
      corner(seed, i, j, dx, dy) * (1.0 - u) + corner(seed, i + 1, j, dx - 1.0, dy) * u;
  const double top = corner(seed, i, j + 1, dx, dy - 1.0) * (1.0 - u) +
                     corner(seed, i + 1, j + 1, dx - 1.0, dy - 1.0) * u;
  return bottom * (1.0 - v) + top * v;
}

double Fractal::operator()(double x, double y) const {
  double sum = 0.0, amplitude = amplitude_m, frequency = 1.0 / wavelength_m;
  for (int k = 0; k < octaves; ++k) {
    // Every octave is shifted, so that the lattices' zeros do not fall together.
    sum += amplitude * gradient_noise(seed + static_cast<std::uint64_t>(k) * 0x51ED27ULL,
                                      x * frequency + 17.31 * k, y * frequency - 9.77 * k);
    amplitude *= gain;
    frequency *= 2.0;
  }
  return sum;
}

}  // namespace lilo::sim
