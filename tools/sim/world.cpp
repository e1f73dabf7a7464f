// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/world.hpp"

#include <stdexcept>

namespace lilo::sim {
namespace {

using Builder = World (*)(std::uint64_t seed, double length_m);

struct Entry {
  WorldInfo info;
  Builder build;
};

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all{
      {{"street", "facades, kerbs, parked and moving cars, trees, people", 8.0}, build_street},
      {{"park", "rough ground, trees, bushes, benches, people; no walls", 2.0}, build_park},
      {{"loop", "a round path of 139 m in a park; stops where it began, in 80 s", 2.0}, build_loop},
      {{"country", "hilly road, ditches, fences, avenues, farms, oncoming cars", 14.0},
       build_country},
      {{"highway", "barriers, gantries, bridges, dense and fast traffic", 25.0}, build_highway},
      {{"field", "open rough ground, a line of posts, few trees", 3.0}, build_field},
      {{"hills", "bare hills and heaps of rubble, hardly a bush", 6.0}, build_hills},
      {{"corridor", "60 m long, 2 m wide, doors; the drive ends before its end", 1.0},
       build_corridor},
  };
  return all;
}

}  // namespace

const std::vector<WorldInfo>& known_worlds() {
  static const std::vector<WorldInfo> infos = [] {
    std::vector<WorldInfo> list;
    for (const Entry& entry : entries()) list.push_back(entry.info);
    return list;
  }();
  return infos;
}

World build_world(const std::string& name, std::uint64_t seed, double length_m) {
  for (const Entry& entry : entries()) {
    if (entry.info.name == name) return entry.build(seed, length_m);
  }
  throw std::invalid_argument("unknown world '" + name + "'");
}

}  // namespace lilo::sim
