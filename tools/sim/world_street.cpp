// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/furniture.hpp"
#include "tools/sim/house.hpp"
#include "tools/sim/noise_field.hpp"
#include "tools/sim/planting.hpp"
#include "tools/sim/plants.hpp"
#include "tools/sim/vehicles.hpp"
#include "tools/sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lilo::sim {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kKerb_m = 4.2;  ///< half the road's width

/// Blocks of nearly straight street with a corner or a bend between them.
std::vector<RouteSegment> street_plan(Random& random, double length_m, double lead_m) {
  std::vector<RouteSegment> segments{{lead_m + random.uniform(25.0, 60.0), 0.0, 0.0}};
  double done = segments.back().length_m, side = random.chance(0.5) ? 1.0 : -1.0;
  while (done < length_m + lead_m + 60.0) {
    // Corners alternate, so that the route leads away and not into its own houses.
    const double turn =
        (random.chance(0.6) ? random.uniform(1.3, 1.6) : random.uniform(0.2, 0.8)) * side;
    const double radius = random.uniform(9.0, 16.0), in = random.uniform(6.0, 10.0);
    const double curvature = std::copysign(1.0 / radius, turn);
    const double middle = std::max(0.5, (std::abs(turn) - in / radius) * radius);
    segments.push_back({in, 0.0, curvature});
    segments.push_back({middle, curvature, curvature});
    segments.push_back({in, curvature, 0.0});
    const double straight = random.uniform(40.0, 110.0);
    const double sway = random.uniform(-1.0, 1.0) / 250.0;
    segments.push_back({0.5 * straight, 0.0, sway});
    segments.push_back({0.5 * straight, sway, 0.0});
    done += 2.0 * in + middle + straight;
    side = -side;
  }
  return segments;
}

Terrain make_ground(const Route& route, std::uint64_t seed) {
  const Fractal hills{seed + 1, 90.0, 2.0, 2, 0.5};
  const Fractal wear{seed + 2, 6.0, 0.035, 4, 0.55};
  const Fractal yards{seed + 3, 5.0, 0.12, 4, 0.6};
  return {route.extent(80.0), 0.25, [&](double x, double y) -> Terrain::Sample {
            const double d = route.distance(x, y, 14.0);
            const double crown = -0.09 * (d / kKerb_m) * (d / kKerb_m);
            const double road = hills(x, y) + wear(x, y);
            // The step to the pavement is hidden inside the kerb stone.
            if (d < kKerb_m + 0.2) return {road + crown, Material::asphalt};
            const double pavement = road - 0.09 + 0.12 + 0.02 * (d - kKerb_m);
            return {pavement + smoothstep(8.0, 14.0, d) * yards(x, y),
                    d < 9.0 ? Material::concrete : Material::grass};
          }};
}

/// Kerb stones one by one: each sits a little differently.
void add_kerbs(World& world, Random& random) {
  for (const double side : {-1.0, 1.0}) {
    for (double arc = world.route.begin_m(); arc < world.route.end_m(); arc += 1.0) {
      if (random.chance(0.03)) continue;  // lowered for a drive
      const RoutePoint p = world.route.at(arc + 0.5);
      if (1.0 / std::max(1e-6, std::abs(p.curvature)) < kKerb_m + 1.0) continue;
      const Vec3 at = p.beside(side * (kKerb_m + 0.25));
      const double top = world.scene.terrain.height(at.x(), at.y());
      const Vec3 edge = p.beside(side * (kKerb_m - 0.3));
      const double road = world.scene.terrain.height(edge.x(), edge.y());
      Mesh stone;
      add_box(stone, {-0.495, -0.25, -0.4}, {0.495, 0.25, 0.0}, Material::concrete);
      const double height = std::max(top, road + 0.1) + random.uniform(-0.012, 0.012);
      append(world.scene.fixed, stone,
             place({at.x(), at.y(), height}, p.yaw_rad + 0.008 * random.normal()));
    }
  }
}

/// True where a house of this width and depth would stand clear of the street.
bool is_clear(const Route& route, const Placement& house, double width_m, double clearance_m) {
  for (double x = 0.0; x <= width_m + 0.1; x += 0.25 * width_m) {
    for (const double y : {0.0, 4.0, 9.0, 14.0}) {
      const Vec3 p = house * Vec3(x, y, 0.0);
      if (route.distance(p.x(), p.y(), clearance_m) < clearance_m) return false;
    }
  }
  return true;
}

void add_gap(World& world, Random& random, double arc, double side, double length) {
  const RoutePoint p = world.route.at(arc);
  const Vec3 at = p.beside(side * random.uniform(6.8, 8.0));
  if (world.route.distance(at.x(), at.y(), 6.0) < 6.0) return;
  const Vec3 foot(at.x(), at.y(), world.scene.terrain.height(at.x(), at.y()));
  Mesh part;
  if (random.chance(0.5)) {
    part = make_hedge(random, length);
  } else {
    add_box(part, {0.0, -0.15, -1.0}, {length, 0.15, random.uniform(0.8, 2.2)}, Material::brick);
  }
  append(world.scene.fixed, part, place(foot, p.yaw_rad));
}

/// Houses along one side, with alleys, gardens and set-backs between them.
void add_houses(World& world, Random& random, double side) {
  for (double arc = world.route.begin_m(); arc < world.route.end_m();) {
    if (random.chance(0.25)) {  // an alley or a garden, now and then a square
      const double gap =
          random.chance(0.25) ? random.uniform(18.0, 45.0) : random.uniform(2.0, 12.0);
      for (double x = 0.0; x + 3.0 < gap; x += 12.0) {
        if (random.chance(0.7)) add_gap(world, random, arc + x, side, std::min(gap - x, 11.0));
      }
      arc += gap;
      continue;
    }
    const double width = random.uniform(6.0, 17.0);
    const RoutePoint p = world.route.at(arc + 0.5 * width);
    const double line =
        random.uniform(7.2, 9.0) + (random.chance(0.2) ? random.uniform(1.0, 4.0) : 0.0);
    const double yaw = p.yaw_rad + (side > 0.0 ? 0.0 : kPi) + 0.02 * random.normal();
    const Vec3 middle = p.beside(side * line);
    Placement house = place(middle, yaw);
    house.translation_m -= house.rotation * Vec3(0.5 * width, 0.0, 0.0);
    house.translation_m.z() =
        world.scene.terrain.height(middle.x(), middle.y()) + random.uniform(-0.05, 0.1);
    if (is_clear(world.route, house, width, 6.3))
      append(world.scene.fixed, make_house(random, width), house);
    arc += width;
  }
}

void add_parked_cars(World& world, Random& random) {
  const ShapeSet cars(world.scene, random, 12, make_car);
  Planter planter(world.scene, world.route, random);
  for (const double side : {-1.0, 1.0}) {
    const double facing = side > 0.0 ? kPi : 0.0;
    for (double arc = world.route.begin_m(); arc < world.route.end_m();
         arc += random.uniform(5.2, 9.0)) {
      if (!random.chance(0.45)) continue;
      const double turned = random.chance(0.2) ? kPi : 0.0;  // some park against the traffic
      planter.stand(cars, arc, side * random.uniform(3.0, 3.2), facing + turned);
    }
  }
}

/// What stands on the pavement on one side.
void add_furniture(World& world, Random& random, double side) {
  Scene& scene = world.scene;
  const ShapeSet lamps(scene, random, 3, make_lamp_post);
  const ShapeSet signs(scene, random, 6, make_sign);
  const ShapeSet bollards(scene, random, 2, make_bollard);
  const ShapeSet bins(scene, random, 5, make_bin);
  const ShapeSet benches(scene, random, 2, make_bench);
  Planter planter(scene, world.route, random);
  const double begin = world.route.begin_m() + 7.0 * side, end = world.route.end_m();
  const double facing = side > 0.0 ? kPi : 0.0;
  for (double arc = begin; arc < end; arc += random.uniform(18.0, 34.0)) {
    planter.stand(lamps, arc, side * random.uniform(4.7, 5.1), facing);
  }
  const auto maybe = [&](double probability, const ShapeSet& set, double arc, double near,
                         double far, double yaw) {
    if (random.chance(probability)) planter.stand(set, arc, side * random.uniform(near, far), yaw);
  };
  for (double arc = begin; arc < end; arc += random.uniform(7.0, 26.0)) {
    maybe(0.4, signs, arc + 2.1, 4.6, 5.2, facing + kPi);
    maybe(0.5, bins, arc + 3.3, 5.0, 6.6, random.angle());
    maybe(0.2, benches, arc + 4.5, 5.6, 6.2, facing);
    if (!random.chance(0.3)) continue;
    for (double k = 0.0; k < 8.0; k += 1.6) planter.stand(bollards, arc + k, side * 4.75, 0.0);
  }
}

void add_plants(World& world, Random& random) {
  const ShapeSet pruned(world.scene, random, 10, make_street_tree);
  const ShapeSet trees(world.scene, random, 8, make_broadleaf_tree);
  const ShapeSet bushes(world.scene, random, 6, make_bush);
  Planter planter(world.scene, world.route, random);
  for (const double side : {-1.0, 1.0}) {
    for (double arc = world.route.begin_m(); arc < world.route.end_m();
         arc += random.uniform(7.0, 26.0)) {
      const double yard = side * random.uniform(9.5, 14.0);
      if (random.chance(0.4)) planter.stand(bushes, arc + 5.0, yard, random.angle());
      const double kerb = side * random.uniform(4.9, 5.6);
      if (random.chance(0.5)) planter.stand(pruned, arc, kerb, random.angle());
    }
  }
  planter.scatter(trees, world.route.extent(60.0), 0.003, 14.0);
}

void add_traffic(World& world, Random& random, double length_m) {
  world.travellers.push_back(
      {.start_m = random.uniform(14.0, 22.0), .left_m = -1.2, .speed_mps = 1.0, .escort = true});
  for (double arc = 25.0; arc < 2.5 * length_m; arc += random.uniform(35.0, 90.0)) {
    world.travellers.push_back({.start_m = arc,
                                .left_m = 1.3,
                                .speed_mps = -random.uniform(6.0, 11.0),
                                .heavy = random.chance(0.1)});
  }
  for (double arc = -10.0; arc < length_m; arc += random.uniform(15.0, 40.0)) {
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    world.travellers.push_back(
        {.kind = TravellerKind::walker,
         .start_m = arc,
         .left_m = side * random.uniform(5.6, 6.4),
         .speed_mps = random.uniform(0.9, 1.7) * (random.chance(0.5) ? 1.0 : -1.0)});
  }
}

}  // namespace

World build_street(std::uint64_t seed, double length_m) {
  Random random(seed, 1);
  constexpr double kLead_m = 60.0;
  World world{Route(street_plan(random, length_m, kLead_m), kLead_m), {}, {}, {}};
  world.vehicle = {.sensor_height_m = 1.9, .lane_m = -1.2};
  world.scene.terrain = make_ground(world.route, seed);
  add_kerbs(world, random);
  add_houses(world, random, 1.0);
  add_houses(world, random, -1.0);
  add_parked_cars(world, random);
  add_furniture(world, random, 1.0);
  add_furniture(world, random, -1.0);
  add_plants(world, random);
  add_traffic(world, random, length_m);
  return world;
}

}  // namespace lilo::sim
