#include "config/config.hpp"
#include "config/key.hpp"
#include "config/yaml_reader.hpp"

#include <fmt/format.h>

#include <cerrno>
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

// Rules between keys. Each key by itself is already in its range.
std::vector<ConfigProblem> contradictions(const Config& c) {
  std::vector<ConfigProblem> found;
  const auto require = [&](bool holds, const char* key, std::string text) {
    if (!holds) found.push_back({.key = key, .text = std::move(text)});
  };
  require(c.sensor.min_range_m < c.sensor.max_range_m, "sensor.min_range_m",
          fmt::format("expected less than sensor.max_range_m ({}), found {}", c.sensor.max_range_m,
                      c.sensor.min_range_m));
  require(c.odometry.min_range_m < c.odometry.max_range_m, "odometry.min_range_m",
          fmt::format("expected less than odometry.max_range_m ({}), found {}",
                      c.odometry.max_range_m, c.odometry.min_range_m));
  require(c.udp.data_port != c.udp.position_port, "udp.position_port",
          fmt::format("expected another port than udp.data_port, found {}", c.udp.position_port));
  return found;
}

// A contradiction stands where its key does; one between defaults cannot be.
void place(ConfigProblem& problem, const std::vector<ConfigEntry>& entries) {
  for (const ConfigEntry& entry : entries) {
    if (entry.key->path != problem.key) continue;
    problem.line = entry.line;
    problem.column = entry.column;
  }
}

void resolve_paths(const std::string& config_path, Config& config) {
  std::string& file = config.sensor.calibration_file;
  if (file.empty() || std::filesystem::path(file).is_absolute()) return;
  file = (std::filesystem::path(config_path).parent_path() / file).lexically_normal().string();
}

}  // namespace

Config load_config(const std::string& path) {
  const std::string text = read_file(path);
  const std::vector<Key> keys = config_keys();
  CheckedYaml yaml = read_yaml(text, keys, config_sections());
  Config config;
  for (const ConfigEntry& entry : yaml.entries) entry.key->set(config, entry.value);
  if (yaml.problems.empty()) {
    yaml.problems = contradictions(config);
    for (ConfigProblem& problem : yaml.problems) place(problem, yaml.entries);
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
