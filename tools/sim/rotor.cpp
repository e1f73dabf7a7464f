// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/rotor.hpp"

#include "tools/sim/random.hpp"

#include <algorithm>
#include <cmath>

namespace lilo::sim {
namespace {

constexpr double kRamp_s = 2.0;

}  // namespace

Rotor::Rotor(const SensorOptions& options, std::uint64_t seed)
    : rate_dps_(6.0 * options.rpm),
      rate_after_dps_(6.0 * options.rpm_after),
      change_at_s_(options.rpm_change_at_s < 0.0 ? 1e12 : options.rpm_change_at_s) {
  Random random(seed, 40);
  start_deg_ = random.uniform(20.0, 340.0);  // a recording starts somewhere in a turn
  wobble_phase_ = random.angle();
}

double Rotor::azimuth_deg(double time_s) const {
  const double before = std::min(time_s, change_at_s_);
  const double since = std::max(0.0, time_s - change_at_s_);
  const double ramp = std::min(since, kRamp_s);
  const double change = rate_after_dps_ - rate_dps_;
  const double turned = rate_dps_ * (before + ramp) + 0.5 * change * ramp * ramp / kRamp_s +
                        rate_after_dps_ * std::max(0.0, since - kRamp_s);
  if (rate_after_dps_ <= 0.0 && since >= kRamp_s) return start_deg_ + turned;  // it stands
  const double wobble = 0.05 * sin_cos(19.0 * time_s + wobble_phase_).sin +
                        0.015 * sin_cos(83.0 * time_s + 2.0 * wobble_phase_).sin;
  return start_deg_ + turned + wobble;
}

double Rotor::time_of(double azimuth_deg_wanted, double latest_s) const {
  double low = 0.0, high = latest_s;
  if (azimuth_deg(low) > azimuth_deg_wanted || azimuth_deg(high) < azimuth_deg_wanted) return -1.0;
  for (int k = 0; k < 80; ++k) {
    const double middle = 0.5 * (low + high);
    (azimuth_deg(middle) < azimuth_deg_wanted ? low : high) = middle;
  }
  return high;
}

std::uint16_t Rotor::encoder(double azimuth_deg) {
  const auto steps = static_cast<std::int64_t>(std::floor(azimuth_deg * 100.0 + 0.5));
  return static_cast<std::uint16_t>(((steps % 36000) + 36000) % 36000);
}

}  // namespace lilo::sim
