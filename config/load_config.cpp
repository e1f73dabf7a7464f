// SPDX-License-Identifier: BSD-3-Clause
#include "config/config.hpp"
#include "config/key.hpp"
#include "config/yaml_reader.hpp"
#include "core/constants.hpp"
#include "core/map/local_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace lilo {
namespace {

constexpr std::size_t kLargestFileBytes = 1 << 20;

std::string read_file(const std::string& path) {
  const auto refuse = [&](const std::string& found) {
    throw ConfigError(path + ": expected a readable YAML file, found: " + found);
  };
  if (std::filesystem::is_directory(path)) refuse("a folder");
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(std::generic_category().message(errno));
  std::string text(kLargestFileBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kLargestFileBytes) refuse("more than 1 MiB");
  // yaml-cpp would stop reading there and say nothing.
  if (text.find('\0') != std::string::npos) refuse("a binary file");
  return text;
}

std::string to_line(const std::string& path, const ConfigProblem& problem) {
  const std::string where = problem.line > 0
                                ? fmt::format("{}:{}:{}: ", path, problem.line, problem.column)
                                : path + ": ";
  return where + (problem.key.empty() ? "" : problem.key + ": ") + problem.text;
}

// A contradiction stands where the first of its keys does that is in the file; one between defaults
// cannot be.
struct Contradiction {
  std::vector<std::string> keys;
  std::string text;
};

// The map forgets what is farther than its radius, and gets points as far away as returns are used.
void check_map(const Config& c, std::vector<Contradiction>& found) {
  const double cell_m = c.odometry.default_profile.cell_m;
  const double radius_m = c.odometry.default_profile.map_radius_m;
  const double range_m = std::min(c.odometry.max_range_m, c.sensor.max_range_m);
  const auto least_m = [&](double within_m) {
    return (within_m + std::max(within_m, range_m)) / core::CellTable::kSafeLevels;
  };
  // Half cells are kept nearby only, but reach as far as returns do.
  const double least_cell_m =
      std::max(least_m(radius_m), 2.0 * least_m(std::min(radius_m, core::map::kHalfCellRadius_m)));
  if (cell_m >= least_cell_m) return;
  found.push_back(
      {{"odometry.default.cell_m", "odometry.default.map_radius_m", "odometry.max_range_m",
        "sensor.max_range_m"},
       fmt::format("expected at least {:.4f} with odometry.default.map_radius_m {} and returns "
                   "from up to {} m (max_range_m), found {}",
                   std::ceil(1e4 * least_cell_m) * 1e-4, radius_m, range_m, cell_m)});
}

// Whether a datagram to `sink` comes to the socket that is bound to that address and port.
bool reaches(const std::string& sink, const std::string& bound_to, int port) {
  const std::size_t colon = sink.rfind(':');
  const std::string name = sink.substr(0, colon);
  const std::string host = name == "localhost" ? "127.0.0.1" : name;
  const bool any = (bound_to == "0.0.0.0" || bound_to == "::") && host.starts_with("127.");
  return sink.substr(colon + 1) == std::to_string(port) && (any || host == bound_to);
}

// What lilod sends to itself it would take for a request, or for a packet of a sensor.
void check_sinks(const Config& c, std::vector<Contradiction>& found) {
  struct Own {
    const char* key;
    const std::string& address;
    int port;
  };
  for (const std::string& sink : c.publish.sinks) {
    for (const Own& own : {Own{"subscribe.port", c.subscribe.bind_address, c.subscribe.port},
                           Own{"udp.data_port", c.udp.bind_address, c.udp.data_port},
                           Own{"udp.position_port", c.udp.bind_address, c.udp.position_port}}) {
      if (own.port == 0 || !reaches(sink, own.address, own.port)) continue;
      found.push_back({{"publish.sinks", own.key},
                       fmt::format("expected other programs' ports, not lilod's own {}, found "
                                   "\"{}\"",
                                   own.key, sink)});
    }
  }
}

// Rules between keys. Each key by itself is already in its range.
std::vector<Contradiction> contradictions(const Config& c) {
  std::vector<Contradiction> found;
  const auto require = [&](bool holds, std::vector<std::string> keys, std::string text) {
    if (!holds) found.push_back({std::move(keys), std::move(text)});
  };
  require(c.sensor.min_range_m < c.sensor.max_range_m, {"sensor.min_range_m", "sensor.max_range_m"},
          fmt::format("expected less than sensor.max_range_m ({}), found {}", c.sensor.max_range_m,
                      c.sensor.min_range_m));
  require(c.odometry.min_range_m < c.odometry.max_range_m,
          {"odometry.min_range_m", "odometry.max_range_m"},
          fmt::format("expected less than odometry.max_range_m ({}), found {}",
                      c.odometry.max_range_m, c.odometry.min_range_m));
  require(c.udp.data_port != c.udp.position_port, {"udp.position_port", "udp.data_port"},
          fmt::format("expected another port than udp.data_port, found {}", c.udp.position_port));
  require(!c.udp.share_ports || !c.udp.sensor_address.empty(),
          {"udp.share_ports", "udp.sensor_address"},
          "expected udp.sensor_address too: whose packets are this lilod's, found none");
  check_map(c, found);
  check_sinks(c, found);
  return found;
}

ConfigProblem placed(const Contradiction& c, const std::vector<ConfigEntry>& entries) {
  ConfigProblem problem{.key = c.keys.front(), .text = c.text};
  for (const std::string& key : c.keys) {
    const auto entry = std::find_if(entries.begin(), entries.end(),
                                    [&](const ConfigEntry& e) { return e.key->path == key; });
    if (entry == entries.end()) continue;
    problem.line = entry->line;
    problem.column = entry->column;
    break;
  }
  return problem;
}

void resolve_paths(const std::string& config_path, Config& config) {
  std::string& file = config.sensor.calibration_file;
  if (file.empty() || std::filesystem::path(file).is_absolute()) return;
  file = (std::filesystem::path(config_path).parent_path() / file).lexically_normal().string();
}

}  // namespace

Config load_config(const std::string& path, EmptyFile empty) {
  const std::string text = read_file(path);
  const std::vector<Key> keys = config_keys();
  CheckedYaml yaml = read_yaml(text, keys, config_sections());
  Config config;
  for (const ConfigEntry& entry : yaml.entries) entry.key->set(config, entry.value);
  if (yaml.problems.empty()) {
    for (const Contradiction& found : contradictions(config)) {
      yaml.problems.push_back(placed(found, yaml.entries));
    }
  }
  if (empty == EmptyFile::refused && yaml.entries.empty() && yaml.problems.empty()) {
    yaml.problems.push_back({.text = "expected at least one key, found none"});
  }
  if (!yaml.problems.empty()) {
    std::string lines;
    for (const ConfigProblem& problem : yaml.problems) {
      if (!lines.empty()) lines += '\n';
      lines += to_line(path, problem);
    }
    throw ConfigError(lines);
  }
  resolve_paths(path, config);
  config.sensor.position_port = config.udp.position_port;
  return config;
}

}  // namespace lilo
