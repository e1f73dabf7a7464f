// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/furniture.hpp"
#include "tools/sim/house.hpp"
#include "tools/sim/noise_field.hpp"
#include "tools/sim/planting.hpp"
#include "tools/sim/plants.hpp"
#include "tools/sim/road_furniture.hpp"
#include "tools/sim/world.hpp"

#include <algorithm>
#include <numbers>

namespace lilo::sim {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kEdge_m = 3.0;  ///< half the road's width

Terrain make_ground(const Route& route, std::uint64_t seed) {
  const Fractal hills{seed + 1, 180.0, 6.0, 3, 0.4};
  const Fractal wear{seed + 2, 5.0, 0.04, 4, 0.55};
  const Fractal fields{seed + 3, 6.0, 0.22, 5, 0.6};
  return {route.extent(90.0), 0.33, [&](double x, double y) -> Terrain::Sample {
            const double d = route.distance(x, y, 12.0);
            const double crown = -0.08 * std::min(1.0, d / kEdge_m);
            const double ditch =
                -0.5 * smoothstep(kEdge_m + 0.8, 5.2, d) * (1.0 - smoothstep(5.6, 7.5, d));
            const double rough = smoothstep(kEdge_m, 9.0, d) * fields(x, y);
            return {hills(x, y) + wear(x, y) + crown + ditch + rough,
                    d < kEdge_m ? Material::asphalt : Material::grass};
          }};
}

/// Rows along one side: an avenue, a fence, a hedge, or nothing, in stretches.
void add_rows(World& world, Random& random, double side) {
  Scene& scene = world.scene;
  const ShapeSet trees(scene, random, 10, make_broadleaf_tree);
  const ShapeSet fences(scene, random, 6, make_fence);
  const ShapeSet hedges(scene, random, 5, [](Random& r) { return make_hedge(r, kPiece_m); });
  const ShapeSet marks(scene, random, 2, make_delineator);
  const ShapeSet signs(scene, random, 4, make_sign);
  Planter planter(scene, world.route, random);
  const double facing = side > 0.0 ? kPi : 0.0, begin = world.route.begin_m(),
               end = world.route.end_m();
  for (double arc = begin; arc < end;) {
    const double stop = std::min(end, arc + random.uniform(30.0, 140.0));
    const int kind = random.below(5);
    for (; arc < stop; arc += kind == 0 ? random.uniform(7.0, 13.0) : kPiece_m) {
      if (kind == 0) planter.stand(trees, arc, side * random.uniform(7.8, 8.8), random.angle());
      if (kind == 1) planter.stand(fences, arc, side * 8.5, facing);
      if (kind == 2) planter.stand(hedges, arc, side * 8.2, 0.0);
    }
  }
  for (double arc = begin + 12.0 * side; arc < end; arc += random.uniform(24.0, 50.0))
    planter.stand(marks, arc, side * (kEdge_m + 0.7), facing);
  for (double arc = begin; arc < end; arc += random.uniform(80.0, 260.0))
    planter.stand(signs, arc, side * (kEdge_m + 1.2), facing + kPi);
}

void add_farms(World& world, Random& random) {
  for (double arc = world.route.begin_m() + 20.0; arc < world.route.end_m();
       arc += random.uniform(90.0, 260.0)) {
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    const RoutePoint p = world.route.at(arc);
    const Vec3 at = p.beside(side * random.uniform(18.0, 34.0));
    if (world.route.distance(at.x(), at.y(), Route::kReach_m) < 16.0) continue;
    const double z = world.scene.terrain.height(at.x(), at.y());
    append(world.scene.fixed, make_house(random, random.uniform(9.0, 24.0)),
           place({at.x(), at.y(), z}, random.angle()));
  }
}

}  // namespace

World build_country(std::uint64_t seed, double length_m) {
  Random random(seed, 4);
  constexpr double kLead_m = 80.0;
  auto segments = winding(random, length_m + kLead_m + 100.0, 30.0, 110.0, 1.0 / 70.0);
  segments.insert(segments.begin(), {kLead_m, 0.0, 0.0});
  World world{Route(segments, kLead_m), {}, {}, {}};
  world.vehicle = {.sensor_height_m = 1.9, .lane_m = -1.4};
  Scene& scene = world.scene;
  scene.terrain = make_ground(world.route, seed);
  add_rows(world, random, 1.0);
  add_rows(world, random, -1.0);
  add_farms(world, random);
  const ShapeSet trees(scene, random, 12, make_broadleaf_tree);
  const ShapeSet conifers(scene, random, 6, make_conifer);
  const ShapeSet bushes(scene, random, 8, make_bush);
  const ShapeSet posts(scene, random, 3, make_line_post);
  const ShapeSet tufts(scene, random, 12, make_grass_tuft);
  Planter planter(scene, world.route, random);
  const Extent near = world.route.extent(Route::kReach_m);
  planter.scatter(trees, near, 0.002, 12.0, Route::kReach_m);
  planter.scatter(conifers, near, 0.001, 12.0, Route::kReach_m);
  planter.scatter(bushes, near, 0.003, 6.5, Route::kReach_m);
  planter.scatter(tufts, world.route.extent(16.0), 0.25, 3.4, 16.0);
  for (double arc = world.route.begin_m(); arc < world.route.end_m(); arc += 45.0)
    planter.stand(posts, arc, 13.0, 0.0);
  for (double arc = 60.0; arc < 2.0 * length_m + 100.0; arc += random.uniform(80.0, 250.0)) {
    world.travellers.push_back({.start_m = arc,
                                .left_m = 1.4,
                                .speed_mps = -random.uniform(13.0, 16.0),
                                .heavy = random.chance(0.2)});
  }
  return world;
}

}  // namespace lilo::sim
