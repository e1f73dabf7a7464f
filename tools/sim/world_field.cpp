// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/furniture.hpp"
#include "tools/sim/noise_field.hpp"
#include "tools/sim/planting.hpp"
#include "tools/sim/plants.hpp"
#include "tools/sim/world.hpp"

namespace lilo::sim {

// Hardly anything to hold on to: gentle rough ground, a line of posts, a tree here and there.
World build_field(std::uint64_t seed, double length_m) {
  Random random(seed, 5);
  constexpr double kLead_m = 30.0;
  auto segments = winding(random, length_m + kLead_m + 40.0, 20.0, 60.0, 1.0 / 40.0);
  segments.insert(segments.begin(), {kLead_m, 0.0, 0.0});
  World world{Route(segments, kLead_m), {}, {}, {}};
  world.vehicle = {.wheelbase_m = 1.6,
                   .track_m = 1.2,
                   .sensor_height_m = 1.3,
                   .wander_m = 0.4,
                   .lateral_acceleration_mps2 = 1.0};
  const Fractal hills{seed + 1, 160.0, 2.0, 2, 0.4};
  const Fractal rough{seed + 2, 3.0, 0.09, 5, 0.6};
  Scene& scene = world.scene;
  scene.terrain =
      Terrain(world.route.extent(110.0), 0.25, [&](double x, double y) -> Terrain::Sample {
        return {hills(x, y) + rough(x, y), Material::grass};
      });
  const ShapeSet posts(scene, random, 4, make_line_post);
  const ShapeSet trees(scene, random, 4, make_broadleaf_tree);
  const ShapeSet bushes(scene, random, 5, make_bush);
  const ShapeSet tufts(scene, random, 16, make_grass_tuft);
  Planter planter(scene, world.route, random);
  const double side = random.chance(0.5) ? 1.0 : -1.0;
  for (double arc = world.route.begin_m() - 20.0; arc < world.route.end_m() + 60.0;
       arc += random.uniform(42.0, 52.0)) {
    planter.stand(posts, arc, side * random.uniform(14.0, 17.0), 0.0);
  }
  planter.scatter(trees, world.route.extent(100.0), 0.00004, 25.0);
  planter.scatter(bushes, world.route.extent(100.0), 0.00008, 10.0);
  planter.scatter(tufts, world.route.extent(20.0), 0.3, 0.0);
  return world;
}

}  // namespace lilo::sim
