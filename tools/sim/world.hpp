// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/motion.hpp"
#include "tools/sim/route.hpp"
#include "tools/sim/scene.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace lilo::sim {

enum class TravellerKind : std::uint8_t { vehicle, walker };

/// Something that moves along the route with its own speed.
struct Traveller {
  TravellerKind kind = TravellerKind::vehicle;
  double start_m = 0.0;    ///< arc length at time 0; `escort`: ahead of the sensor instead
  double left_m = 0.0;     ///< of the route's line
  double speed_mps = 0.0;  ///< negative: against the route; its heading follows
  bool escort = false;     ///< keeps about its distance to the sensor (the car in front)
  bool heavy = false;      ///< a truck
};

/// A place to drive through.
struct World {
  Route route;
  Vehicle vehicle;
  Scene scene;
  std::vector<Traveller> travellers;
};

/// Names that build_world() knows, with one line about each.
struct WorldInfo {
  std::string name, about;
  double default_speed_mps;
};
const std::vector<WorldInfo>& known_worlds();

/// Throws std::invalid_argument for an unknown name. `length_m`: how far the sensor may drive.
World build_world(const std::string& name, std::uint64_t seed, double length_m);

World build_street(std::uint64_t seed, double length_m);
World build_park(std::uint64_t seed, double length_m);
/// Always 139 m long: the sensor stops where it began.
World build_loop(std::uint64_t seed, double length_m);
World build_highway(std::uint64_t seed, double length_m);
World build_country(std::uint64_t seed, double length_m);
World build_field(std::uint64_t seed, double length_m);
World build_hills(std::uint64_t seed, double length_m);
/// Always 60 m long; the sensor stops before its end.
World build_corridor(std::uint64_t seed, double length_m);

/// Gives every traveller its shape and its motion; call before Scene::finish(). Travellers that
/// would come within reach of the sensor's own path stay beside it by their lane.
void add_travellers(World& world, const Drive& drive, double duration_s, std::uint64_t seed);

}  // namespace lilo::sim
