// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/noise_field.hpp"
#include "tools/sim/planting.hpp"
#include "tools/sim/plants.hpp"
#include "tools/sim/random.hpp"
#include "tools/sim/world.hpp"

#include <algorithm>

namespace lilo::sim {

// Bare hills, heaps of rubble beside the way, hardly a bush. Nearly all that is seen is ground, and
// every crest shows other ground.
World build_hills(std::uint64_t seed, double length_m) {
  Random random(seed, 8);
  constexpr double kLead_m = 30.0;
  auto segments = winding(random, length_m + kLead_m + 40.0, 15.0, 50.0, 1.0 / 25.0);
  segments.insert(segments.begin(), {kLead_m, 0.0, 0.0});
  World world{Route(segments, kLead_m), {}, {}, {}};
  world.vehicle = {.wheelbase_m = 2.4,
                   .track_m = 1.6,
                   .sensor_height_m = 2.0,
                   .wander_m = 0.3,
                   .lateral_acceleration_mps2 = 1.5};
  const Fractal hills{seed + 1, 110.0, 16.0, 2, 0.2};
  const Fractal heaps{seed + 2, 45.0, 12.0, 1, 0.5};
  const Fractal rough{seed + 3, 3.0, 0.12, 5, 0.6};
  Scene& scene = world.scene;
  scene.terrain =
      Terrain(world.route.extent(110.0), 0.25, [&](double x, double y) -> Terrain::Sample {
        const double beside = smoothstep(3.0, 12.0, world.route.distance(x, y, 12.0));
        const double heap_m = std::max(0.0, heaps(x, y) - 1.5);
        return {hills(x, y) + beside * heap_m + (0.3 + 0.7 * beside) * rough(x, y),
                Material::grass};
      });
  const ShapeSet bushes(scene, random, 5, make_bush);
  Planter planter(scene, world.route, random);
  planter.scatter(bushes, world.route.extent(100.0), 0.0004, 4.0);
  return world;
}

}  // namespace lilo::sim
