// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/worlds/world_list.hpp"

#include "tools/bench/worlds/default_worlds.hpp"
#include "tools/text_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace lilo::worlds {
namespace {

constexpr std::array kSources{Source::sim, Source::velosim, Source::recording};
constexpr std::array kRoles{Role::choose, Role::report};
constexpr std::array kSensors{"vlp16", "vlp32c", "hdl32e", "hdl64e", "vls128"};

/// Reads one list; knows its name for messages.
class Parser {
 public:
  explicit Parser(const std::string& name) : name_(name) {}

  WorldList list(const YAML::Node& root) const {
    expect_keys(root, {"seeds", "worlds"});
    WorldList list;
    if (const YAML::Node seeds = root["seeds"]) {
      expect_keys(seeds, {"choose", "report"});
      list.choose = seeds_of(seeds["choose"]);
      list.report = seeds_of(seeds["report"]);
    }
    const YAML::Node rows = root["worlds"];
    if (!rows || !rows.IsSequence()) throw error(root, "expected a sequence 'worlds', found none");
    for (const YAML::Node& row : rows) add(row, list);
    return list;
  }

  [[nodiscard]] std::runtime_error error(const YAML::Mark& mark, const std::string& what) const {
    return std::runtime_error(fmt::format("{}:{}: {}", name_, mark.line + 1, what));
  }

 private:
  [[nodiscard]] std::runtime_error error(const YAML::Node& node, const std::string& what) const {
    return error(node.Mark(), what);
  }

  void expect_keys(const YAML::Node& node, const std::vector<std::string>& known) const {
    if (!node.IsMap()) {
      throw error(node, fmt::format("expected the keys {}, found none", fmt::join(known, ", ")));
    }
    for (const auto& entry : node) {
      const auto key = entry.first.as<std::string>("");
      if (std::find(known.begin(), known.end(), key) != known.end()) continue;
      throw error(entry.first,
                  fmt::format("expected one of {}, found '{}'", fmt::join(known, ", "), key));
    }
  }

  std::vector<std::uint64_t> seeds_of(const YAML::Node& node) const {
    std::vector<std::uint64_t> seeds;
    if (!node) return seeds;
    if (!node.IsSequence()) throw error(node, "expected a sequence of seeds, found something else");
    for (const YAML::Node& item : node) {
      std::uint64_t seed = 0;
      if (!YAML::convert<std::uint64_t>::decode(item, seed)) {
        throw error(item, fmt::format("expected a seed, found '{}'", item.as<std::string>("")));
      }
      seeds.push_back(seed);
    }
    return seeds;
  }

  [[nodiscard]] std::string text(const YAML::Node& row, const char* key) const {
    const YAML::Node value = row[key];
    if (!value || !value.IsScalar()) {
      throw error(row, fmt::format("expected the key {}, found none", key));
    }
    return value.as<std::string>();
  }

  /// The one of `all` that the row names.
  template <typename Choice, std::size_t N>
  Choice choice(const YAML::Node& row, const char* key, const std::array<Choice, N>& all) const {
    const std::string found = text(row, key);
    std::vector<std::string> names;
    for (const Choice one : all) {
      names.emplace_back(name_of(one));
      if (found == names.back()) return one;
    }
    throw error(row[key], fmt::format("{}: expected one of {}, found '{}'", key,
                                      fmt::join(names, ", "), found));
  }
  static const char* name_of(const char* text) { return text; }
  template <typename Choice>
  static const char* name_of(Choice choice) {
    return to_string(choice);
  }

  /// A name becomes one of folders.
  [[nodiscard]] std::string name_of_row(const YAML::Node& row, const WorldList& list) const {
    std::string name = text(row, "name");
    const auto good = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.';
    };
    if (name.empty() || name.front() == '.' || !std::all_of(name.begin(), name.end(), good)) {
      throw error(row["name"],
                  fmt::format("name: expected letters, digits, '_', '-', '.', found '{}'", name));
    }
    const bool taken = std::any_of(list.worlds.begin(), list.worlds.end(),
                                   [&](const World& world) { return world.name == name; });
    if (taken) throw error(row["name"], fmt::format("expected another name, found {} twice", name));
    return name;
  }

  void add(const YAML::Node& row, WorldList& list) const {
    World world{.name = "", .source = Source::sim};
    if (!row.IsMap()) throw error(row, "expected a row {name: ..., source: ..., ...}, found none");
    world.source = choice(row, "source", kSources);
    const bool recorded = world.source == Source::recording;
    expect_keys(row, recorded ? std::vector<std::string>{"name", "source", "config", "path", "role"}
                              : std::vector<std::string>{"name", "source", "config", "arguments"});
    world.name = name_of_row(row, list);
    world.sensor = choice(row, "config", kSensors);
    if (recorded) {
      world.path = text(row, "path");
      if (row["role"]) world.role = choice(row, "role", kRoles);
    } else {
      std::istringstream words(text(row, "arguments"));
      world.arguments.assign(std::istream_iterator<std::string>(words), {});
    }
    list.worlds.push_back(std::move(world));
  }

  const std::string& name_;
};

}  // namespace

const char* to_string(Source source) {
  switch (source) {
    case Source::sim:
      return "sim";
    case Source::velosim:
      return "velosim";
    case Source::recording:
      return "recording";
  }
  return "?";
}

const char* to_string(Role role) { return role == Role::choose ? "choose" : "report"; }

WorldList parse_world_list(const std::string& text, const std::string& name) {
  const Parser parser(name);
  try {
    return parser.list(YAML::Load(text));
  } catch (const YAML::Exception& problem) {
    throw parser.error(problem.mark, fmt::format("expected YAML, found: {}", problem.msg));
  }
}

WorldList read_world_list(const std::string& path) {
  std::ifstream file = open_text(path);
  return parse_world_list({std::istreambuf_iterator<char>(file), {}}, path);
}

WorldList default_world_list() { return parse_world_list(kDefaultWorlds, "worlds.yaml"); }

}  // namespace lilo::worlds
