// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/hdl64_table.hpp"

#include "tools/sim/random.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace lilo::sim {
namespace {

/// Place of each laser of a bank when sorted by elevation: the same on every unit.
constexpr std::array<int, 32> kRank{4,  5,  26, 27, 6,  7,  0,  1,  8,  9,  2,  3,  16, 17, 10, 11,
                                    18, 19, 12, 13, 20, 21, 14, 15, 28, 29, 22, 23, 30, 31, 24, 25};
/// Horizontal angle of the lasers, by rank; repeats every twelve.
constexpr std::array<double, 12> kRotation_deg{-1.7, 1.7, 5.1, 8.5, -7.2, -3.8,
                                               -0.4, 3.0, 6.4, 9.8, -8.5, -5.1};

/// Where the unit's distances were calibrated.
constexpr double kFar_m = 25.04, kNearX_m = 2.40, kNearY_m = 1.93;

/// What differs between the banks and the series.
struct Bank {
  double lowest_deg, highest_deg;
  double rotation_scale;
  double offset_lowest_m, offset_highest_m;  ///< of the beam's origin above the base
};

Bank bank_of(Sensor sensor, bool upper) {
  if (sensor == Sensor::hdl64_s2) {
    return upper ? Bank{-8.4, 2.0, 1.0, 0.193, 0.213} : Bank{-24.8, -9.0, 1.0, 0.105, 0.124};
  }
  return upper ? Bank{-8.5, 2.0, 0.67, 0.217, 0.205} : Bank{-24.6, -8.8, 1.0, 0.163, 0.144};
}

double stepped(double value, double step) { return std::floor(value / step + 0.5) * step; }
double stepped_deg(double value_deg) { return stepped(value_deg, 0.01) * std::numbers::pi / 180.0; }

}  // namespace

std::vector<LaserCorrection> make_hdl64_table(Sensor sensor, bool two_point, std::uint64_t seed) {
  Random random(seed, 70);
  std::vector<LaserCorrection> table(64);
  for (std::size_t id = 0; id < table.size(); ++id) {
    const Bank bank = bank_of(sensor, id < 32);
    const int rank = kRank[id % 32];
    const double up = rank / 31.0;
    LaserCorrection& c = table[id];
    c.elevation_rad = stepped_deg(bank.lowest_deg + up * (bank.highest_deg - bank.lowest_deg) +
                                  0.05 * random.normal());
    c.rotation_rad =
        stepped_deg(bank.rotation_scale * kRotation_deg[static_cast<std::size_t>(rank % 12)] +
                    0.25 * random.normal());
    c.distance_m = stepped(random.uniform(1.24, 1.58), 0.001);
    c.distance_x_m = stepped(c.distance_m + random.uniform(-0.005, 0.06), 0.001);
    c.distance_y_m = stepped(c.distance_m + random.uniform(-0.03, 0.06), 0.001);
    if (!two_point) c.distance_x_m = c.distance_y_m = c.distance_m;
    c.vertical_offset_m =
        stepped(bank.offset_lowest_m + up * (bank.offset_highest_m - bank.offset_lowest_m), 0.001);
    c.horizontal_offset_m = id % 2 == 0 ? 0.026 : -0.026;
    c.focal_distance_m = stepped(random.uniform(0.25, 24.0), 0.25);
    c.focal_slope = stepped(random.uniform(0.4, 2.0), 0.1);
    c.min_intensity = 5 * random.below(13);
    c.max_intensity = 255;
  }
  return table;
}

Vec3 hdl64_point(const LaserCorrection& laser, double raw_m, double angle_rad, bool two_point) {
  const SinCos angle = sin_cos(angle_rad), elevation = sin_cos(laser.elevation_rad);
  const double h = laser.horizontal_offset_m, range = raw_m + laser.distance_m;
  double range_x = range, range_y = range;  // the manual's x is to the right, its y ahead
  if (two_point && range < kFar_m) {
    const double flat = range * elevation.cos;
    const double across = std::abs(flat * angle.sin - h * angle.cos);
    const double ahead = std::abs(flat * angle.cos + h * angle.sin);
    range_x = raw_m + laser.distance_x_m +
              (laser.distance_m - laser.distance_x_m) * (across - kNearX_m) / (kFar_m - kNearX_m);
    range_y = raw_m + laser.distance_y_m +
              (laser.distance_m - laser.distance_y_m) * (ahead - kNearY_m) / (kFar_m - kNearY_m);
  }
  const double across = range_x * elevation.cos * angle.sin - h * angle.cos;
  const double ahead = range_y * elevation.cos * angle.cos + h * angle.sin;
  return {ahead, -across, 0.5 * (range_x + range_y) * elevation.sin + laser.vertical_offset_m};
}

}  // namespace lilo::sim
