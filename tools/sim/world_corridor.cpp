// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/noise_field.hpp"
#include "tools/sim/planting.hpp"
#include "tools/sim/world.hpp"

#include <algorithm>

namespace lilo::sim {
namespace {

constexpr double kBegin_m = -3.0, kEnd_m = 57.0;  ///< 60 m between the end walls
constexpr double kHalf_m = 1.0, kHeight_m = 2.6;

/// One wall along x in panels that are not quite flush, with doors in recesses.
void add_wall(Mesh& mesh, Random& random, double side) {
  for (double x = kBegin_m; x < kEnd_m;) {
    const bool door = random.chance(0.16) && x < kEnd_m - 1.5;
    const double width = door ? 0.95 : std::min(random.uniform(0.6, 1.4), kEnd_m - x);
    const double set = door ? random.uniform(0.06, 0.14) : random.uniform(-0.004, 0.004);
    const double y = side * (kHalf_m + set);
    const double top = door ? 2.05 : kHeight_m;
    add_quad(mesh, {x, y, -0.05}, {width, 0, 0}, {0, 0, top + 0.05},
             door ? Material::paint : Material::plaster);
    // Joints stand out a little; they also close the slit between panels at different depths.
    const double joint = side * (kHalf_m - 0.005);
    for (const double edge : {x, x + width}) {
      add_quad(mesh, {edge, joint, -0.05}, {0, y - joint, 0}, {0, 0, kHeight_m + 0.05},
               Material::plaster);
    }
    if (door) {
      const double wall = side * kHalf_m;
      add_quad(mesh, {x, wall, top}, {width, 0, 0}, {0, 0, kHeight_m - top}, Material::plaster);
      add_quad(mesh, {x, wall, top}, {width, 0, 0}, {0, y - wall, 0}, Material::plaster);
      const double knob = x + 0.85, out = y - side * 0.05;
      add_box(mesh, {knob - 0.06, std::min(out, y), 1.0}, {knob + 0.06, std::max(out, y), 1.04},
              Material::metal);
    }
    x += width;
  }
}

/// The little that stands or hangs in a corridor.
void add_fittings(Mesh& mesh, Random& random) {
  for (double x = kBegin_m + 1.0; x < kEnd_m; x += random.uniform(2.7, 3.3)) {
    add_box(mesh, {x, -0.3, kHeight_m - 0.06}, {x + 1.2, 0.3, kHeight_m}, Material::plaster);
  }
  for (double x = kBegin_m + 4.0; x < kEnd_m - 2.0; x += random.uniform(7.0, 16.0)) {
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    const double wall = side * kHalf_m;
    if (random.chance(0.5)) {  // a fire extinguisher
      add_frustum(mesh, {x, wall - side * 0.1, 0.7}, {x, wall - side * 0.1, 1.2}, 0.08, 0.07, 16,
                  Material::paint);
    } else {  // a notice board
      const double y = wall - side * 0.03;
      add_box(mesh, {x, std::min(y, wall), 1.1}, {x + 1.2, std::max(y, wall), 1.9}, Material::bark);
    }
  }
  const double tray = 0.75;
  add_box(mesh, {kBegin_m, tray, 2.35}, {kEnd_m, tray + 0.2, 2.42}, Material::metal);
}

}  // namespace

// 60 m long and 2 m wide: what lies ahead tells hardly anything about how far one has come.
World build_corridor(std::uint64_t seed, double /*length_m*/) {
  Random random(seed, 6);
  World world{Route({{kEnd_m - 5.0, 0.0, 0.0}}, 1.0), {}, {}, {}};
  world.vehicle = {.wheelbase_m = 0.4,
                   .track_m = 0.4,
                   .sensor_height_m = 0.8,
                   .wander_m = 0.15,
                   .lateral_acceleration_mps2 = 0.8};
  const Fractal floor{seed + 1, 2.0, 0.004, 3, 0.5};
  world.scene.terrain = Terrain({kBegin_m - 1.0, -2.0, kEnd_m + 1.0, 2.0}, 0.25,
                                [&](double x, double y) -> Terrain::Sample {
                                  return {floor(x, y), Material::concrete};
                                });
  Mesh& mesh = world.scene.fixed;
  add_wall(mesh, random, 1.0);
  add_wall(mesh, random, -1.0);
  add_fittings(mesh, random);
  const double length = kEnd_m - kBegin_m;
  add_quad(mesh, {kBegin_m, -1.3, kHeight_m}, {length, 0, 0}, {0, 2.6, 0}, Material::plaster);
  for (const double x : {kBegin_m, kEnd_m}) {
    add_quad(mesh, {x, -1.3, -0.1}, {0, 2.6, 0}, {0, 0, kHeight_m + 0.1}, Material::plaster);
  }
  return world;
}

}  // namespace lilo::sim
