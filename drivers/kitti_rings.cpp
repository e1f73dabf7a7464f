// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/kitti_rings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lilo {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr int kMinRings = 60, kMaxRingsFound = 64;
// HDL-64E manual, table of vertical angles: lasers spread from -24.9 to +2 degrees.
constexpr int kBinCount = 64;
constexpr float kLowestBinRad = -24.9F * kPi / 180.0F, kHighestBinRad = 2.0F * kPi / 180.0F;

float elevation_rad(const Return& r) { return std::atan2(r.z_m, std::hypot(r.x_m, r.y_m)); }

// Index of the first return of each ring. The azimuth falling from behind to ahead begins one, if
// most of a turn lies between; noise around straight ahead does not.
std::vector<std::size_t> ring_starts(const Returns& returns) {
  std::vector<std::size_t> starts;
  float highest = 0.0F, before = 0.0F;
  for (std::size_t i = 0; i < returns.size(); ++i) {
    const float ccw = returns[i].azimuth_rad;
    const float a = ccw < 0.0F ? ccw + 2.0F * kPi : ccw;
    if (i == 0 || (before - a > kPi && highest > 1.5F * kPi)) {
      starts.push_back(i);
      highest = 0.0F;
    }
    // A point just short of a full turn at a ring's start is noise, not the end of the ring.
    if (a - before < kPi) highest = std::max(highest, a);
    before = a;
  }
  return starts;
}

float median_elevation(const Returns& returns, std::size_t begin, std::size_t end,
                       std::vector<float>& scratch) {
  scratch.clear();
  for (std::size_t i = begin; i < end; ++i) scratch.push_back(elevation_rad(returns[i]));
  const auto middle = scratch.begin() + static_cast<std::ptrdiff_t>(scratch.size() / 2);
  std::nth_element(scratch.begin(), middle, scratch.end());
  return *middle;
}

bool rings_from_order(Returns& returns, BeamTable& beams) {
  auto bounds = ring_starts(returns);
  const int count = static_cast<int>(bounds.size());
  if (count < kMinRings || count > kMaxRingsFound) return false;
  bounds.push_back(returns.size());
  std::vector<float> scratch;
  beams.ring_count = count;
  for (int stored = 0; stored < count; ++stored) {
    const auto s = static_cast<std::size_t>(stored);
    const auto ring = static_cast<std::size_t>(count - 1 - stored);
    beams.elevation_rad[ring] = median_elevation(returns, bounds[s], bounds[s + 1], scratch);
    for (std::size_t i = bounds[s]; i < bounds[s + 1]; ++i)
      returns[i].ring = static_cast<std::uint8_t>(ring);
  }
  return std::is_sorted(beams.elevation_rad.begin(), beams.elevation_rad.begin() + count);
}

void rings_from_elevation(Returns& returns, BeamTable& beams) {
  constexpr float kStep = (kHighestBinRad - kLowestBinRad) / (kBinCount - 1);
  beams.ring_count = kBinCount;
  for (int i = 0; i < kBinCount; ++i)
    beams.elevation_rad[static_cast<std::size_t>(i)] =
        kLowestBinRad + static_cast<float>(i) * kStep;
  for (Return& r : returns) {
    const float bin = std::round((elevation_rad(r) - kLowestBinRad) / kStep);
    r.ring = static_cast<std::uint8_t>(std::clamp(bin, 0.0F, kBinCount - 1.0F));
  }
}

}  // namespace

void recover_kitti_rings(Returns& returns, BeamTable& beams) {
  beams = {};
  if (!rings_from_order(returns, beams)) rings_from_elevation(returns, beams);
}

}  // namespace lilo
