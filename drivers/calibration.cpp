// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/calibration.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace lilo {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

struct Limit {
  const char* name;
  double LaserCorrection::*value;
  double low, high;
};

// Well beyond every table published, well within what a wrong byte makes.
constexpr Limit kLimits[] = {
    {"vertical angle", &LaserCorrection::vert_rad, -35.0 * kRadPerDeg, 25.0 * kRadPerDeg},
    {"rotational angle", &LaserCorrection::rot_rad, -25.0 * kRadPerDeg, 25.0 * kRadPerDeg},
    {"distance correction", &LaserCorrection::dist_m, -3.0, 5.0},
    {"distance correction x", &LaserCorrection::dist_x_m, -3.0, 5.0},
    {"distance correction y", &LaserCorrection::dist_y_m, -3.0, 5.0},
    {"vertical offset", &LaserCorrection::vert_offset_m, -0.5, 0.5},
    {"horizontal offset", &LaserCorrection::horiz_offset_m, -0.2, 0.2},
    {"focal distance", &LaserCorrection::focal_distance_m, -0.001, 131.0},
    {"focal slope", &LaserCorrection::focal_slope, -0.001, 100.0},
};

std::string describe(std::size_t laser, const Limit& limit, double value) {
  char text[160];
  std::snprintf(text, sizeof(text), "laser %zu: %s %g is not between %g and %g", laser, limit.name,
                value, limit.low, limit.high);
  return text;
}

}  // namespace

std::string implausible(const Calibration& calibration) {
  double lowest = 1.0, highest = -1.0;
  for (std::size_t i = 0; i < calibration.lasers.size(); ++i) {
    const LaserCorrection& laser = calibration.lasers[i];
    for (const Limit& limit : kLimits) {
      const double value = laser.*limit.value;
      if (!(value >= limit.low && value <= limit.high)) return describe(i, limit, value);
    }
    lowest = std::fmin(lowest, laser.vert_rad);
    highest = std::fmax(highest, laser.vert_rad);
  }
  if (highest - lowest < 15.0 * kRadPerDeg) return "the lasers do not spread over 15 degrees";
  if (!(calibration.distance_step_m > 0.0005 && calibration.distance_step_m < 0.01))
    return "the distance step is not between 0.5 and 10 mm";
  return {};
}

}  // namespace lilo
