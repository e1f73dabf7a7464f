// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/worlds/world_list.hpp"

#include "tools/bench/worlds/drive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <string>

namespace lilo::worlds {
namespace {

constexpr const char* kList = R"(seeds:
  choose: [11, 12]
  report: [21]
worlds:
  - {name: park, source: velosim, config: hdl64e, arguments: "--world park --vibration 10:2"}
  - {name: town, source: recording, config: vlp16, path: some/where, role: report}
)";

TEST(WorldList, IsReadRowByRow) {
  const WorldList list = parse_world_list(kList, "list.yaml");
  EXPECT_EQ(list.choose, (std::vector<std::uint64_t>{11, 12}));
  EXPECT_EQ(list.report, (std::vector<std::uint64_t>{21}));
  ASSERT_EQ(list.worlds.size(), 2U);
  EXPECT_EQ(list.worlds[0].source, Source::velosim);
  EXPECT_EQ(list.worlds[0].sensor, "hdl64e");
  EXPECT_EQ(list.worlds[0].arguments,
            (std::vector<std::string>{"--world", "park", "--vibration", "10:2"}));
  EXPECT_EQ(list.worlds[1].path, "some/where");
  EXPECT_EQ(list.worlds[1].role, Role::report);
}

std::string error_of(const std::string& text) {
  try {
    parse_world_list(text, "list.yaml");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

TEST(WorldList, MistakesNameTheirLine) {
  const std::string row = "worlds:\n  - {name: a, source: sim, config: vlp16, arguments: }\n";
  EXPECT_EQ(error_of(row + "seed: 3\n"),
            "list.yaml:3: expected one of seeds, worlds, found 'seed'");
  EXPECT_EQ(error_of("seeds: {choose: [1, two]}\n" + row),
            "list.yaml:1: expected a seed, found 'two'");
  EXPECT_EQ(error_of("seeds: {}\n"), "list.yaml:1: expected a sequence 'worlds', found none");
  EXPECT_EQ(error_of("worlds:\n  - {name: a, source: simm, config: vlp16, arguments: x}\n"),
            "list.yaml:2: source: expected one of sim, velosim, recording, found 'simm'");
  EXPECT_EQ(
      error_of("worlds:\n  - {name: a, source: sim, config: vlp32, arguments: x}\n"),
      "list.yaml:2: config: expected one of vlp16, vlp32c, hdl32e, hdl64e, vls128, found 'vlp32'");
  EXPECT_EQ(error_of("worlds:\n  - {name: a, source: sim, config: vlp16, path: x}\n"),
            "list.yaml:2: expected one of name, source, config, arguments, found 'path'");
  EXPECT_EQ(error_of("worlds:\n  - {name: a, source: sim, config: vlp16}\n"),
            "list.yaml:2: expected the key arguments, found none");
  EXPECT_EQ(error_of("worlds:\n  - {name: ../a, source: sim, config: vlp16, arguments: x}\n"),
            "list.yaml:2: name: expected letters, digits, '_', '-', '.', found '../a'");
  const std::string twice = "  - {name: a, source: sim, config: vlp16, arguments: x}\n";
  EXPECT_EQ(error_of("worlds:\n" + twice + twice),
            "list.yaml:3: expected another name, found a twice");
  EXPECT_EQ(error_of("worlds:\n  - {name: a\n").substr(0, 30), "list.yaml:3: expected YAML, fo");
}

TEST(WorldList, TheBuiltInOneIsGood) {
  const WorldList list = default_world_list();
  EXPECT_GE(list.worlds.size(), 30U);
  for (const std::uint64_t seed : list.choose) {
    EXPECT_EQ(std::count(list.report.begin(), list.report.end(), seed), 0)
        << "what is chosen on is no test";
  }
  EXPECT_GE(list.choose.size(), 2U);
}

TEST(WorldList, OfModelsDrivesEachThroughTheSameWorlds) {
  const WorldList list =
      read_world_list(std::string(LILO_TOOLS_TESTS_DIR) + "/../../tools/bench/worlds/models.yaml");
  std::map<std::string, std::set<std::string>> sensors_by_world;
  for (const World& world : list.worlds) {
    ASSERT_EQ(world.arguments.size(), 6U) << world.name;
    EXPECT_EQ(world.arguments[0], "--world");
    sensors_by_world[world.arguments[1]].insert(world.arguments[5]);
  }
  EXPECT_EQ(sensors_by_world.size(), 3U);
  const std::set<std::string> models{"vlp16", "vlp16-hires", "vlp32c", "hdl32e", "vls128"};
  for (const auto& [name, sensors] : sensors_by_world) EXPECT_EQ(sensors, models) << name;
}

TEST(Drives, AreAllSeedsOfTheWorldsAskedFor) {
  const WorldList list = parse_world_list(kList, "list.yaml");
  const auto labels = [&](const std::vector<Role>& roles, const std::string& only) {
    std::string text;
    for (const Drive& drive : drives_of(list, roles, only)) text += label(drive) + ';';
    return text;
  };
  EXPECT_EQ(labels({Role::choose, Role::report}, ""), "park 11;park 12;park 21;town;");
  EXPECT_EQ(labels({Role::choose}, ""), "park 11;park 12;");
  EXPECT_EQ(labels({Role::report}, ""), "park 21;town;");
  EXPECT_EQ(labels({Role::choose, Role::report}, "^t|nothing"), "town;");
  EXPECT_THROW(labels({Role::choose}, "("), std::runtime_error);
}

}  // namespace
}  // namespace lilo::worlds
