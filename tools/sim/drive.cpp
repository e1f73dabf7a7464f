// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/motion.hpp"
#include "tools/sim/noise_field.hpp"

#include <algorithm>
#include <cmath>

namespace lilo::sim {
namespace {

constexpr double kAcceleration_mps2 = 1.3;
constexpr double kBraking_mps2 = 1.6;
constexpr double kGrid_m = 0.5;

/// Highest speed at every kGrid_m of the route: the wish, curves, and braking in time for both.
std::vector<double> speed_limits(const MotionOptions& options, const Vehicle& vehicle,
                                 const Route& route) {
  const int count = static_cast<int>((route.end_m() - route.begin_m()) / kGrid_m) + 1;
  std::vector<double> limits(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    const double arc = route.begin_m() + k * kGrid_m;
    const double mood = 1.0 + 0.15 * gradient_noise(options.seed + 77, arc / 45.0, 0.5);
    const double curvature = std::abs(route.at(arc).curvature);
    const double wish = options.speed_mps * mood;
    limits[static_cast<std::size_t>(k)] =
        std::min(wish, std::sqrt(vehicle.lateral_acceleration_mps2 / std::max(curvature, 1e-6)));
  }
  limits.back() = 0.0;  // the route ends here
  for (std::size_t k = limits.size() - 1; k-- > 0;) {
    const double next = limits[k + 1];
    limits[k] = std::min(limits[k], std::sqrt(next * next + 2.0 * kBraking_mps2 * kGrid_m));
  }
  return limits;
}

/// Moving average over 2 * half + 1 values, the ends held.
std::vector<double> smoothed(const std::vector<double>& values, int half) {
  const int n = static_cast<int>(values.size());
  std::vector<double> result(values.size());
  for (int k = 0; k < n; ++k) {
    double sum = 0.0;
    for (int i = k - half; i <= k + half; ++i) {
      sum += values[static_cast<std::size_t>(std::clamp(i, 0, n - 1))];
    }
    result[static_cast<std::size_t>(k)] = sum / (2 * half + 1);
  }
  return result;
}

}  // namespace

Drive::Drive(const MotionOptions& options, const Vehicle& vehicle, const Route& route) {
  const std::vector<double> limits = speed_limits(options, vehicle, route);
  const auto limit = [&](double arc) {
    const double u = std::clamp((arc - route.begin_m()) / kGrid_m, 0.0,
                                static_cast<double>(limits.size()) - 1.001);
    const auto k = static_cast<std::size_t>(u);
    return limits[k] + (u - static_cast<double>(k)) * (limits[k + 1] - limits[k]);
  };
  const int lead = static_cast<int>(kLead_s / kStep_s);
  const int count = static_cast<int>(options.duration_s / kStep_s) + 2 * lead + 1;
  const double start_speed = options.start_in_motion ? limit(0.0) : 0.0;
  double arc = -start_speed * kLead_s, speed = start_speed;
  for (int k = 0; k < count; ++k) {
    const double time = (k - lead) * kStep_s;
    const bool waiting = !options.start_in_motion && time < options.standstill_s;
    const bool held = options.start_in_motion && time < 0.0;
    if (!held) {
      const double wish = waiting ? 0.0 : limit(arc + speed * kStep_s);
      speed = std::clamp(wish, std::max(0.0, speed - 1.5 * kBraking_mps2 * kStep_s),
                         speed + kAcceleration_mps2 * kStep_s);
    }
    speed_.push_back(speed);
    arc += speed * kStep_s;
  }
  // Twice a moving average makes the acceleration continuous.
  speed_ = smoothed(smoothed(speed_, 30), 20);
  arc_.push_back(-start_speed * kLead_s);
  for (std::size_t k = 1; k < speed_.size(); ++k) {
    arc_.push_back(arc_.back() + 0.5 * (speed_[k - 1] + speed_[k]) * kStep_s);
  }
}

double Drive::at(const std::vector<double>& table, double time_s) {
  const double u =
      std::clamp((time_s + kLead_s) / kStep_s, 0.0, static_cast<double>(table.size()) - 1.001);
  const auto k = static_cast<std::size_t>(u);
  return table[k] + (u - static_cast<double>(k)) * (table[k + 1] - table[k]);
}

}  // namespace lilo::sim
