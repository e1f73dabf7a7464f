// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/furniture.hpp"
#include "tools/sim/noise_field.hpp"
#include "tools/sim/planting.hpp"
#include "tools/sim/plants.hpp"
#include "tools/sim/world.hpp"

#include <numbers>
#include <utility>

namespace lilo::sim {
namespace {

Terrain make_ground(const Route& route, std::uint64_t seed) {
  const Fractal hills{seed + 1, 45.0, 2.2, 3, 0.45};
  const Fractal rough{seed + 2, 4.0, 0.16, 5, 0.6};
  return {route.extent(100.0), 0.25, [&](double x, double y) -> Terrain::Sample {
            // The path has been walked on: smoother than the grass, not smooth.
            const double off = smoothstep(0.9, 3.0, route.distance(x, y, 3.0));
            const double height = hills(x, y) + (0.3 + 0.7 * off) * rough(x, y);
            return {height, off < 0.5 ? Material::soil : Material::grass};
          }};
}

void add_walkers(World& world, Random& random, double length_m) {
  const int count = 3 + static_cast<int>(length_m / 60.0);
  for (int k = 0; k < count; ++k) {
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    world.travellers.push_back(
        {.kind = TravellerKind::walker,
         .start_m = random.uniform(2.0, length_m),
         .left_m = side * random.uniform(1.8, 7.0),
         .speed_mps = random.uniform(0.8, 1.7) * (random.chance(0.5) ? 1.0 : -1.0)});
  }
  world.travellers.push_back({.kind = TravellerKind::walker,
                              .start_m = 6.0,
                              .left_m = 0.8,
                              .speed_mps = 1.0,
                              .escort = true});
}

/// A park around a path.
World planted(Route route, Random& random, std::uint64_t seed, double length_m) {
  World world{std::move(route), {}, {}, {}};
  world.vehicle = {.wheelbase_m = 0.6,
                   .track_m = 0.5,
                   .sensor_height_m = 0.9,
                   .wander_m = 0.5,
                   .lateral_acceleration_mps2 = 0.8};
  Scene& scene = world.scene;
  scene.terrain = make_ground(world.route, seed);

  const ShapeSet trees(scene, random, 14, make_broadleaf_tree);
  const ShapeSet bare(scene, random, 4, make_bare_tree);
  const ShapeSet conifers(scene, random, 5, make_conifer);
  const ShapeSet bushes(scene, random, 12, make_bush);
  const ShapeSet tufts(scene, random, 16, make_grass_tuft);
  const ShapeSet rocks(scene, random, 8, make_rock);
  const ShapeSet lamps(scene, random, 3, make_lamp_post);
  const ShapeSet benches(scene, random, 4, make_bench);
  const ShapeSet bins(scene, random, 3, make_bin);

  Planter planter(scene, world.route, random);
  const Extent all = world.route.extent(90.0);
  planter.scatter(trees, all, 0.006, 2.5);
  planter.scatter(bare, all, 0.0008, 2.5);
  planter.scatter(conifers, all, 0.0015, 3.0);
  planter.scatter(bushes, all, 0.006, 2.0);
  planter.scatter(rocks, all, 0.001, 1.5);
  planter.scatter(tufts, world.route.extent(25.0), 0.5, 1.0, 25.0);
  for (double arc = world.route.begin_m(); arc < world.route.end_m();
       arc += random.uniform(14.0, 40.0)) {
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    planter.stand(lamps, arc, side * random.uniform(1.4, 2.5), -side * std::numbers::pi);
    if (random.chance(0.6))
      planter.stand(benches, arc + random.uniform(2.0, 9.0), -side * random.uniform(1.8, 2.8),
                    side > 0 ? std::numbers::pi : 0.0);
    if (random.chance(0.4))
      planter.stand(bins, arc + random.uniform(2.0, 9.0), side * random.uniform(1.6, 2.4), 0.0);
  }
  add_walkers(world, random, length_m);
  return world;
}

}  // namespace

World build_park(std::uint64_t seed, double length_m) {
  Random random(seed, 2);
  constexpr double kLead_m = 30.0;
  auto segments = winding(random, length_m + kLead_m + 30.0, 8.0, 22.0, 1.0 / 12.0);
  segments.insert(segments.begin(), {kLead_m, 0.0, 0.0});
  return planted(Route(segments, kLead_m), random, seed, length_m);
}

World build_loop(std::uint64_t seed, double length_m) {
  // Four equal quarters, each turning by 90 degrees, close whatever their shape. Lengths are whole
  // steps of the route.
  constexpr double kStraight_m = 12.0, kRamp_m = 4.0, kBend_m = 14.75;
  constexpr double kCurvature = 0.5 * std::numbers::pi / (kRamp_m + kBend_m);
  std::vector<RouteSegment> segments;
  for (int quarter = 0; quarter < 4; ++quarter) {
    segments.push_back({kStraight_m, 0.0, 0.0});
    segments.push_back({kRamp_m, 0.0, kCurvature});
    segments.push_back({kBend_m, kCurvature, kCurvature});
    segments.push_back({kRamp_m, kCurvature, 0.0});
  }
  Random random(seed, 9);
  return planted(Route(segments, 0.0), random, seed, length_m);
}

}  // namespace lilo::sim
