// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/options.hpp"

namespace lilo::sim {

/// The turning head. Degrees count clockwise as the sensor does and never wrap. The speed wanders
/// a little, as on real units (0.04 deg rms over a revolution).
class Rotor {
 public:
  Rotor(const SensorOptions& options, std::uint64_t seed);

  [[nodiscard]] double azimuth_deg(double time_s) const;
  /// When the head comes to `azimuth_deg`, not after `latest_s`; negative if it does not.
  [[nodiscard]] double time_of(double azimuth_deg, double latest_s) const;

  /// The sensor's 0.01 degree encoder: 0 to 35999.
  [[nodiscard]] static std::uint16_t encoder(double azimuth_deg);

 private:
  double start_deg_, wobble_phase_;
  double rate_dps_, rate_after_dps_, change_at_s_;
};

}  // namespace lilo::sim
