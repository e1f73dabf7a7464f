// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tool_config.hpp"

#include "config/key.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace lilo {
namespace {

Key key_at(const std::string& path) {
  const std::vector<Key> keys = config_keys();
  return *std::find_if(keys.begin(), keys.end(), [&](const Key& k) { return k.path == path; });
}

/// The choice `name` for the key at `path`, as `option` of the command line asks.
void choose(Config& config, const char* option, const char* path, const std::string& name) {
  const Key key = key_at(path);
  const std::vector<std::string>& known = key.choices;
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    throw std::runtime_error(
        fmt::format("{}: expected one of {}, found {}", option, fmt::join(known, ", "), name));
  }
  key.set(config, name);
}

}  // namespace

std::vector<std::string> choices_of_key(const std::string& path) { return key_at(path).choices; }

Config tool_config(const std::string& file, const std::string& profile, const std::string& sensor) {
  Config config = file.empty() ? Config{} : load_config(file);
  if (!profile.empty()) choose(config, "--profile", "odometry.profile", profile);
  if (!sensor.empty()) choose(config, "--sensor", "sensor.model", sensor);
  return config;
}

}  // namespace lilo
