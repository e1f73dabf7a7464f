#include "tools/sim/world.hpp"

#include <stdexcept>

namespace lilo::sim {

const std::vector<WorldInfo>& known_worlds() {
  static const std::vector<WorldInfo> worlds{
      {"street", "facades, kerbs, parked and moving cars, trees, people", 8.0},
      {"park", "rough ground, trees, bushes, benches, people; no walls", 2.0},
  };
  return worlds;
}

World build_world(const std::string& name, std::uint64_t seed, double length_m) {
  if (name == "street") return build_street(seed, length_m);
  if (name == "park") return build_park(seed, length_m);
  throw std::invalid_argument("unknown world '" + name + "'");
}

}  // namespace lilo::sim
