// SPDX-License-Identifier: BSD-3-Clause
#include "config/print_config.hpp"

#include "config/key.hpp"
#include "core/odometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <unistd.h>

namespace lilo {
namespace {

const std::string kFolder = LILO_CONFIG_DIR;
constexpr const char* kHardPath = "/tmp/\"quoted\" \\name";

std::string contents(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Config round_trip(const Config& config) {
  const std::string path = testing::TempDir() + "lilo_print_" + std::to_string(getpid()) + ".yaml";
  std::ofstream(path) << print_config(config);
  Config back = load_config(path);
  std::filesystem::remove(path);
  return back;
}

/// A value other than the one given that the key accepts, near the far end of its range.
Value another_value(const Key& key, const Value& now) {
  switch (key.type) {
    case KeyType::boolean:
      return !std::get<bool>(now);
    case KeyType::integer: {
      const auto top = static_cast<std::int64_t>(key.max);
      return now == Value(top) ? Value(top - 1) : Value(top);
    }
    case KeyType::real:
      return key.max - (key.max - key.min) * 0.01;
    case KeyType::choice:
      return now == Value(key.choices.back()) ? key.choices.front() : key.choices.back();
    case KeyType::text:
      return std::string(key.form.valid(kHardPath) ? kHardPath : "10.0.0.1");
    case KeyType::list:
      if (key.form.valid("10.0.0.1")) return std::vector<std::string>{"10.0.0.1", "10.0.0.2"};
      return std::vector<std::string>{"10.0.0.1:1", "localhost:65535"};
  }
  return now;
}

TEST(PrintConfig, DefaultsComeBack) {
  EXPECT_TRUE(differing_keys(config_keys(), round_trip({}), {}).empty());
}

// Every key by itself: set, printed and read it is the new value, and nothing else has changed.
TEST(PrintConfig, EveryKeyIsItsOwn) {
  const std::vector<Key> keys = config_keys();
  for (const Key& key : keys) {
    if (key.path.find("min_range") != std::string::npos) continue;  // bound to max_range
    if (key.path == "odometry.default.map_radius_m") continue;      // bound to cell_m
    if (key.path == "udp.share_ports") continue;                    // bound to sensor_address
    if (key.choices.size() == 1) continue;
    if (key.path == "odometry.profile" && !has_profile(Profile::paper)) continue;
    Config changed;
    const Value value = another_value(key, key.get(changed));
    key.set(changed, value);
    const auto differing = differing_keys(keys, changed, {});
    ASSERT_EQ(differing.size(), 1U) << key.path;
    EXPECT_EQ(differing[0]->path, key.path);
    EXPECT_EQ(to_yaml(key.get(round_trip(changed))), to_yaml(value)) << key.path;
  }
}

TEST(KeyTable, DefaultsAreInRangeAndPathsAreUnique) {
  std::set<std::string> seen;
  const Config defaults;
  for (const Key& key : config_keys()) {
    EXPECT_TRUE(seen.insert(key.path).second) << key.path;
    EXPECT_FALSE(key.meaning.empty()) << key.path;
    const Value value = key.get(defaults);
    const double* real = std::get_if<double>(&value);
    const auto* whole = std::get_if<std::int64_t>(&value);
    if (real != nullptr) {
      EXPECT_TRUE(*real >= key.min && *real <= key.max) << key.path;
    }
    if (whole != nullptr) {
      const auto number = static_cast<double>(*whole);
      EXPECT_TRUE(number >= key.min && number <= key.max) << key.path;
    }
  }
}

TEST(KeyTable, EveryKeyStandsInASection) {
  const auto sections = config_sections();
  for (const Key& key : config_keys()) {
    const std::string parent = key.path.substr(0, key.path.rfind('.'));
    EXPECT_TRUE(std::any_of(sections.begin(), sections.end(), [&](const Section& s) {
      return s.path == parent;
    })) << key.path;
  }
}

TEST(KeyTable, UnitIsInTheNameOfTheKey) {
  for (const Key& key : config_keys()) {
    if (key.unit.empty() || key.unit == "scans" || key.unit == "B") continue;
    const std::string suffix = "_" + key.unit;
    EXPECT_TRUE(key.path.ends_with(suffix)) << key.path << " is in " << key.unit;
  }
}

class ShippedFile : public testing::TestWithParam<const char*> {};

// The comments of the shipped files are the table's: a shipped file is a heading and its own print.
TEST_P(ShippedFile, IsWhatPrintConfigPrints) {
  const std::string path = kFolder + '/' + GetParam();
  const std::string text = contents(path);
  const std::size_t heading_end = text.find("\n\n");
  ASSERT_NE(heading_end, std::string::npos);
  EXPECT_EQ(text.substr(heading_end + 2), print_config(load_config(path)));
}

TEST_P(ShippedFile, DiffersFromTheDefaultsInSensorAndSinkOnly) {
  const Config shipped = load_config(kFolder + '/' + GetParam());
  const auto keys = config_keys();
  const std::set<std::string> allowed = {"sensor.model", "publish.sinks"};
  for (const Key* key : differing_keys(keys, shipped, {})) {
    EXPECT_TRUE(allowed.contains(key->path)) << key->path;
  }
  EXPECT_EQ(shipped.publish.sinks, std::vector<std::string>{"127.0.0.1:9870"});
}

INSTANTIATE_TEST_SUITE_P(PrintConfig, ShippedFile,
                         testing::Values("vlp16.yaml", "vlp32c.yaml", "hdl32e.yaml", "hdl64e.yaml",
                                         "vls128.yaml"),
                         [](const auto& test) {
                           const std::string file = test.param;
                           return file.substr(0, file.find('.'));
                         });

TEST(PrintReference, IsTheFileInTheRepository) {
  EXPECT_EQ(contents(kFolder + "/REFERENCE.md"), print_reference())
      << "lilod --print-reference > config/REFERENCE.md";
}

}  // namespace
}  // namespace lilo
