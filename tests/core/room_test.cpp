// SPDX-License-Identifier: BSD-3-Clause
// The height of a sensor in a room, of whose floor 16 beams see nothing.
#include "core/odometry.hpp"
#include "tests/core/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace lilo {
namespace {

const BeamTable k16 = test::even_beams(16, -15.0, 15.0);

const std::vector<test::Plane> kWalls = {{{-1.0, 0.0, 0.0}, -4.0},
                                         {{1.0, 0.0, 0.0}, -4.0},
                                         {{0.0, -1.0, 0.0}, -3.0},
                                         {{0.0, 1.0, 0.0}, -3.0}};

// By hand through a room of 8 x 6 m whose floor 16 beams do not reach: only the ceiling, 1.1 m
// above, tells the height.
TEST(Room, TheCeilingHoldsTheHeight) {
  test::Scene room;
  room.planes = kWalls;
  room.planes.push_back({{0.0, 0.0, -1.0}, -1.1});
  const auto carried = [](double t_s) {
    const double step = std::min(t_s, 1.0) * std::sin(5.0 * t_s);
    return Pose{so3_exp({0.05 * step, 0.04 * step, 0.1 * t_s}), {0.2 * t_s, 0.0, 0.08 * step}};
  };
  Odometry odometry{OdometryConfig{}};
  std::mt19937 rng(3);
  double worst_m = 0.0;
  for (std::uint64_t k = 0; k < 40; ++k) {
    const double at_s = 0.1 * static_cast<double>(k);
    Scan scan = test::scan_of(
        room, k16, 900, [&](double s) { return carried(at_s + 0.1 * s); }, k);
    test::add_range_noise(scan, 0.01F, rng);
    const Pose found = carried(0.1) * odometry.process(scan).T_odom_sensor;
    const Pose truth = carried(at_s + 0.1);
    worst_m = std::max(worst_m, std::abs(found.translation_m.z() - truth.translation_m.z()));
  }
  EXPECT_LT(worst_m, 0.03);
}

}  // namespace
}  // namespace lilo
