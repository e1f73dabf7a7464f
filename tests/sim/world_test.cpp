// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/world.hpp"

#include "tools/sim/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <tuple>

namespace lilo::sim {
namespace {

class Worlds : public testing::TestWithParam<std::tuple<std::string, std::uint64_t>> {};

/// Nearest surface around the sensor, level with it.
double nearest_around(const Scene& scene, const Placement& pose, double time_s) {
  double nearest = 1e9;
  for (int k = 0; k < 48; ++k) {
    const SinCos a = sin_cos(2.0 * std::numbers::pi * k / 48);
    const Vec3 along = pose.rotation * Vec3(a.cos, a.sin, 0.0);
    nearest = std::min(nearest, scene.cast(pose.translation_m, along, time_s, 50.0).range_m);
  }
  return nearest;
}

// A drive that leads through a tree or a car would make a set no odometry can be blamed for.
TEST_P(Worlds, DriveIsClearAndOnTheGround) {
  const std::string& name = std::get<0>(GetParam());
  const std::uint64_t seed = std::get<1>(GetParam());
  const auto info = std::find_if(known_worlds().begin(), known_worlds().end(),
                                 [&](const WorldInfo& w) { return w.name == name; });
  ASSERT_NE(info, known_worlds().end());
  const MotionOptions motion{
      .speed_mps = info->default_speed_mps, .duration_s = 20.0, .seed = seed};
  World world = build_world(name, seed, motion.speed_mps * motion.duration_s);
  const Drive drive(motion, world.vehicle, world.route);
  const SensorPath path(motion, world.vehicle, world.route, drive, world.scene.terrain);
  add_travellers(world, drive, motion.duration_s, seed);
  world.scene.finish();
  for (double t = 0.0; t < motion.duration_s; t += 0.1) {
    const Placement pose = path.at(t);
    EXPECT_GT(nearest_around(world.scene, pose, t), 0.55) << "at " << t << " s";
    const Vec3& p = pose.translation_m;
    const double above = p.z() - world.scene.terrain.height(p.x(), p.y());
    EXPECT_NEAR(above, world.vehicle.sensor_height_m, 0.3) << "at " << t << " s";
    // Upright within a vehicle's pitch and roll on its worst ground.
    EXPECT_GT(pose.rotation(2, 2), std::cos(0.25)) << "at " << t << " s";
  }
  EXPECT_GT(drive.arc_m(motion.duration_s), 0.4 * motion.speed_mps * motion.duration_s);
}

INSTANTIATE_TEST_SUITE_P(All, Worlds,
                         testing::Combine(testing::Values("street", "park", "loop", "country",
                                                          "highway", "field", "hills", "corridor"),
                                          testing::Values(2U)),
                         [](const auto& test_case) {
                           return std::get<0>(test_case.param) +
                                  std::to_string(std::get<1>(test_case.param));
                         });

// Closure tables need a drive that ends where it began, and heads as it did then.
TEST(World, LoopCloses) {
  const World world = build_world("loop", 3, 160.0);
  const RoutePoint begin = world.route.at(0.0), end = world.route.at(world.route.end_m());
  EXPECT_NEAR(std::hypot(end.x - begin.x, end.y - begin.y), 0.0, 1e-6);
  EXPECT_NEAR(end.yaw_rad - begin.yaw_rad, 2.0 * std::numbers::pi, 1e-9);
  const MotionOptions motion{.speed_mps = 2.0, .duration_s = 80.0, .seed = 3};
  const Drive drive(motion, world.vehicle, world.route);
  const SensorPath path(motion, world.vehicle, world.route, drive, world.scene.terrain);
  const Vec3 gap = path.at(80.0).translation_m - path.at(0.0).translation_m;
  EXPECT_LT(gap.norm(), 0.01 * world.route.end_m());
  EXPECT_GT(drive.arc_m(80.0), 0.98 * world.route.end_m());
}

TEST(World, UnknownNameIsRefused) {
  EXPECT_THROW(build_world("moon", 1, 100.0), std::invalid_argument);
}

TEST(Route, DistanceIsThatOfACircle) {
  constexpr double kRadius = 50.0;
  const Route route({{250.0, 1.0 / kRadius, 1.0 / kRadius}}, 0.0);
  Random random(1);
  for (int k = 0; k < 2000; ++k) {
    const double angle = random.uniform(0.3, 4.0), off = random.uniform(-20.0, 20.0);
    const double x = (kRadius + off) * std::sin(angle);
    const double y = kRadius - (kRadius + off) * std::cos(angle);
    EXPECT_NEAR(route.distance(x, y, 30.0), std::abs(off), 0.02);
  }
}

}  // namespace
}  // namespace lilo::sim
