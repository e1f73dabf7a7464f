// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace lilo::sim {

/// Smooth random function of the plane (gradient noise on a unit lattice, quintic blend), about in
/// [-0.7, 0.7], with zero mean. Same seed, same function.
double gradient_noise(std::uint64_t seed, double x, double y);

/// Sum of `octaves` gradient noises; the first has the given wavelength and amplitude, each further
/// one half the wavelength and `gain` times the amplitude.
struct Fractal {
  std::uint64_t seed = 0;
  double wavelength_m = 1.0;
  double amplitude_m = 1.0;
  int octaves = 1;
  double gain = 0.5;

  [[nodiscard]] double operator()(double x, double y) const;
};

}  // namespace lilo::sim
