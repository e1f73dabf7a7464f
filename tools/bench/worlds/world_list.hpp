// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lilo::worlds {

/// Who made what a row holds.
enum class Source : std::uint8_t { sim, velosim, recording };

/// What may be done with what a seed brings: choose constants by it, or only report it.
enum class Role : std::uint8_t { choose, report };
const char* to_string(Source source);
const char* to_string(Role role);

/// A row of the list.
struct World {
  std::string name;  ///< of letters, digits, '_', '-' and '.'
  Source source = Source::sim;
  std::string sensor;                  ///< sensor.model of the configuration
  std::vector<std::string> arguments;  ///< of the simulator, without seed and folder
  std::string path;                    ///< of a recording: for find_sets()
  Role role = Role::choose;            ///< of a recording; that of a simulation is its seed's
};

struct WorldList {
  std::vector<World> worlds;
  std::vector<std::uint64_t> choose, report;  ///< seeds
};

/// A list as in worlds.yaml; `name` is the file, for messages. Throws std::runtime_error, one line,
/// "file:line: ..., expected ..., found ...".
WorldList parse_world_list(const std::string& text, const std::string& name);
WorldList read_world_list(const std::string& path);

/// worlds.yaml as it was built in.
WorldList default_world_list();

}  // namespace lilo::worlds
