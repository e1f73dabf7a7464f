#include "tools/tool_config.hpp"

#include "config/key.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace lilo {
namespace {

void set_profile(Config& config, const std::string& name) {
  const std::vector<Key> keys = config_keys();
  const auto key = std::find_if(keys.begin(), keys.end(),
                                [](const Key& k) { return k.path == "odometry.profile"; });
  const std::vector<std::string>& known = key->choices;
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    throw std::runtime_error(
        fmt::format("--profile: expected one of {}, found {}", fmt::join(known, ", "), name));
  }
  key->set(config, name);
}

}  // namespace

Config tool_config(const std::string& file, const std::string& profile) {
  Config config = file.empty() ? Config{} : load_config(file);
  if (!profile.empty()) set_profile(config, profile);
  return config;
}

}  // namespace lilo
