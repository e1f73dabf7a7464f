// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/noise_field.hpp"
#include "tools/sim/planting.hpp"
#include "tools/sim/plants.hpp"
#include "tools/sim/road_furniture.hpp"
#include "tools/sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lilo::sim {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kEdge_m = 12.0;     ///< paved to here, from the line between the carriageways
constexpr double kSlowLane_m = 7.0;  ///< middle of the outer lane
constexpr double kFastLane_m = 3.4;

Terrain make_ground(const Route& route, std::uint64_t seed) {
  const Fractal hills{seed + 1, 420.0, 14.0, 2, 0.4};
  const Fractal country{seed + 2, 60.0, 5.0, 4, 0.5};
  const Fractal wear{seed + 3, 9.0, 0.02, 4, 0.55};
  const Fractal rough{seed + 4, 5.0, 0.18, 4, 0.6};
  return {route.extent(100.0), 0.5, [&](double x, double y) -> Terrain::Sample {
            const double d = route.distance(x, y, Route::kReach_m);
            const double away = smoothstep(kEdge_m + 1.0, 34.0, d);
            const double road = hills(x, y) + wear(x, y) - 0.02 * std::min(d, kEdge_m);
            const double verge = smoothstep(kEdge_m, kEdge_m + 3.0, d);
            const double height = road + away * country(x, y) + verge * rough(x, y);
            return {height, d < kEdge_m ? Material::asphalt : Material::grass};
          }};
}

/// Rows of pieces along the road, in stretches that start and end at random.
void add_row(Planter& planter, Random& random, const Route& route, const ShapeSet& set, double left,
             double share) {
  const double facing = left > 0.0 ? 0.0 : kPi;
  double arc = route.begin_m();
  while (arc < route.end_m()) {
    const double end = arc + random.uniform(60.0, 300.0);
    const bool there = random.chance(share);
    for (; arc < std::min(end, route.end_m()); arc += kPiece_m) {
      if (there) planter.stand(set, arc, left, facing);
    }
  }
}

void add_barriers(World& world, Random& random) {
  Scene& scene = world.scene;
  const ShapeSet rails(scene, random, 8, make_guard_rail);
  const ShapeSet concrete(scene, random, 4, make_concrete_barrier);
  const ShapeSet walls(scene, random, 8, make_noise_wall);
  Planter planter(scene, world.route, random);
  add_row(planter, random, world.route, concrete, 0.02, 0.5);
  add_row(planter, random, world.route, rails, 0.9, 0.9);
  add_row(planter, random, world.route, rails, -0.9, 0.9);
  for (const double side : {-1.0, 1.0}) {
    add_row(planter, random, world.route, rails, side * (kEdge_m + 0.3), 0.7);
    add_row(planter, random, world.route, walls, side * (kEdge_m + 3.5), 0.2);
  }
}

void add_signs(World& world, Random& random) {
  Scene& scene = world.scene;
  const double half = kEdge_m + 1.2;
  const ShapeSet gantries(scene, random, 3, [&](Random& r) { return make_gantry(r, half); });
  const ShapeSet bridges(scene, random, 2, [&](Random& r) { return make_bridge(r, half + 1.5); });
  const ShapeSet signs(scene, random, 6, make_road_sign);
  Planter planter(scene, world.route, random);
  const double begin = world.route.begin_m(), end = world.route.end_m();
  for (double arc = begin + 90.0; arc < end; arc += random.uniform(200.0, 450.0))
    planter.stand(gantries, arc, 0.0, 0.0);
  for (double arc = begin + 260.0; arc < end; arc += random.uniform(500.0, 900.0))
    planter.stand(bridges, arc, 0.0, random.uniform(-0.2, 0.2));
  for (double arc = begin; arc < end; arc += random.uniform(50.0, 160.0)) {
    planter.stand(signs, arc, -random.uniform(kEdge_m + 1.0, kEdge_m + 2.5), 0.0);
    planter.stand(signs, arc + 31.0, random.uniform(kEdge_m + 1.0, kEdge_m + 2.5), kPi);
  }
}

void add_plants(World& world, Random& random) {
  const ShapeSet trees(world.scene, random, 10, make_broadleaf_tree);
  const ShapeSet conifers(world.scene, random, 5, make_conifer);
  const ShapeSet bushes(world.scene, random, 10, make_bush);
  Planter planter(world.scene, world.route, random);
  const Extent near = world.route.extent(Route::kReach_m);
  planter.scatter(trees, near, 0.003, kEdge_m + 5.5, Route::kReach_m);
  planter.scatter(conifers, near, 0.001, kEdge_m + 5.5, Route::kReach_m);
  planter.scatter(bushes, near, 0.004, kEdge_m + 4.5, Route::kReach_m);
}

void add_traffic(World& world, Random& random, double length_m) {
  const auto add = [&](double start, double left, double speed, bool escort = false) {
    world.travellers.push_back({.start_m = start,
                                .left_m = left,
                                .speed_mps = speed,
                                .escort = escort,
                                .heavy = std::abs(left) > 5.0 && random.chance(0.4)});
  };
  add(random.uniform(25.0, 45.0), -kSlowLane_m, 1.0, true);
  add(-random.uniform(20.0, 35.0), -kSlowLane_m, 1.0, true);
  for (double arc = -900.0; arc < 60.0; arc += random.uniform(60.0, 220.0)) {
    add(arc, -kFastLane_m, random.uniform(29.0, 31.0));
  }
  for (double arc = 0.0; arc < 2.4 * length_m + 200.0; arc += random.uniform(45.0, 140.0)) {
    const bool slow = random.chance(0.5);
    add(arc, slow ? kSlowLane_m : kFastLane_m, slow ? -23.0 : -30.0);
  }
}

}  // namespace

World build_highway(std::uint64_t seed, double length_m) {
  Random random(seed, 3);
  constexpr double kLead_m = 150.0;
  auto segments = winding(random, length_m + kLead_m + 150.0, 80.0, 220.0, 1.0 / 600.0);
  segments.insert(segments.begin(), {kLead_m, 0.0, 0.0});
  World world{Route(segments, kLead_m), {}, {}, {}};
  world.vehicle = {.sensor_height_m = 1.9, .lane_m = -kSlowLane_m};
  world.scene.terrain = make_ground(world.route, seed);
  add_barriers(world, random);
  add_signs(world, random);
  add_plants(world, random);
  add_traffic(world, random, length_m);
  return world;
}

}  // namespace lilo::sim
