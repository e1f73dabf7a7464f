// SPDX-License-Identifier: BSD-3-Clause
#include "config/config.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <unistd.h>

namespace lilo {
namespace {

/// A YAML file that lives as long as the object.
class YamlFile {
 public:
  explicit YamlFile(const std::string& text)
      : path_(testing::TempDir() + "lilo_load_" + std::to_string(getpid()) + ".yaml") {
    std::ofstream(path_) << text;
  }
  ~YamlFile() { std::filesystem::remove(path_); }
  YamlFile(const YamlFile&) = delete;
  YamlFile& operator=(const YamlFile&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// The error lines of a text with the name of the file taken off; "" when it loads.
std::string errors_of(const std::string& yaml) {
  const YamlFile file(yaml);
  try {
    load_config(file.path());
  } catch (const ConfigError& error) {
    std::string text = error.what();
    for (auto at = text.find(file.path()); at != std::string::npos; at = text.find(file.path())) {
      text.erase(at, file.path().size() + 1);
    }
    return text;
  }
  return "";
}

TEST(LoadConfig, ReadsEveryType) {
  const YamlFile file(
      "sensor:\n  model: hdl64e\n  cut_azimuth_deg: 90\n  min_range_m: 1.5e0\n"
      "udp:\n  data_port: 2369\n  bind_address: 127.0.0.1\n"
      "publish:\n  sinks: [\"127.0.0.1:9870\", localhost:9000]\n"
      "realtime:\n  lock_memory: true\n  worker_cpu: -1\n");
  const Config c = load_config(file.path());
  EXPECT_EQ(c.sensor.model, SensorModel::hdl64e);
  EXPECT_DOUBLE_EQ(c.sensor.cut_azimuth_rad, std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(c.sensor.min_range_m, 1.5);
  EXPECT_EQ(c.udp.data_port, 2369);
  EXPECT_EQ(c.udp.bind_address, "127.0.0.1");
  EXPECT_EQ(c.publish.sinks, (std::vector<std::string>{"127.0.0.1:9870", "localhost:9000"}));
  EXPECT_TRUE(c.realtime.lock_memory);
  EXPECT_EQ(c.realtime.worker_cpu, -1);
}

TEST(LoadConfig, KeysLeftOutKeepTheirDefaults) {
  for (const char* text : {"", "# nothing\n", "sensor:\n", "---\nudp: {}\n"}) {
    const YamlFile file(text);
    const Config c = load_config(file.path());
    EXPECT_EQ(c.udp.data_port, 2368) << text;
    EXPECT_EQ(c.sensor.model, SensorModel::automatic) << text;
  }
}

TEST(LoadConfig, AFileWithoutKeysIsRefusedWhereItMayNotBeEmpty) {
  for (const char* text : {"", "# nothing\n", "publish:\n"}) {
    const YamlFile file(text);
    try {
      load_config(file.path(), EmptyFile::refused);
      ADD_FAILURE() << "\"" << text << "\" was read";
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.what(), file.path() + ": expected at least one key, found none");
    }
  }
  const YamlFile one("udp:\n  data_port: 2368\n");
  EXPECT_EQ(load_config(one.path(), EmptyFile::refused).udp.data_port, 2368);
}

TEST(LoadConfig, TakesSinksOnOtherPortsAndOtherHosts) {
  EXPECT_EQ(errors_of("publish:\n  sinks: [\"127.0.0.1:9870\", \"10.0.0.7:9871\"]\n"), "");
  EXPECT_EQ(errors_of("subscribe:\n  port: 0\npublish:\n  sinks: [\"127.0.0.1:9871\"]\n"), "");
}

TEST(LoadConfig, CapturesHaveTheirPositionPacketsOnTheConfiguredPort) {
  const YamlFile file("udp:\n  position_port: 8400\n");
  EXPECT_EQ(load_config(file.path()).sensor.position_port, 8400);
}

TEST(LoadConfig, CalibrationFileIsRelativeToTheConfiguration) {
  const YamlFile file("sensor:\n  calibration_file: unit/db.xml\n");
  const auto folder = std::filesystem::path(file.path()).parent_path();
  EXPECT_EQ(load_config(file.path()).sensor.calibration_file, folder / "unit/db.xml");
}

TEST(LoadConfig, TakesCellsJustLargeEnoughForTheMap) {
  EXPECT_EQ(errors_of("odometry:\n  default:\n    cell_m: 0.235\n"), "");
  EXPECT_EQ(errors_of("odometry:\n  max_range_m: 20\n  default:\n    cell_m: 0.1\n"
                      "    map_radius_m: 51\n"),
            "");
}

TEST(LoadConfig, MissingFileIsOneLine) {
  try {
    load_config("/nonexistent/x.yaml");
    FAIL() << "a missing file was read";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "/nonexistent/x.yaml: expected a readable YAML file, found: No such file or "
                 "directory");
  }
}

struct BadCase {
  const char* name;
  const char* yaml;
  const char* error;
};

class BadConfig : public testing::TestWithParam<BadCase> {};

TEST_P(BadConfig, SaysWhereWhatAndWhy) { EXPECT_EQ(errors_of(GetParam().yaml), GetParam().error); }

INSTANTIATE_TEST_SUITE_P(
    LoadConfig, BadConfig,
    testing::Values(
        BadCase{"UnknownKey", "udp:\n  data_prot: 1\n",
                "2:3: udp.data_prot: expected a known key, found \"data_prot\"; did you mean "
                "udp.data_port?"},
        BadCase{"UnknownSection", "\nsenzor:\n  model: auto\n",
                "2:1: senzor: expected a known key, found \"senzor\"; did you mean sensor?"},
        BadCase{"KeyOfAnotherSection", "udp:\n  worker_cpu: 1\n",
                "2:3: udp.worker_cpu: expected a known key, found \"worker_cpu\"; did you mean "
                "realtime.worker_cpu?"},
        BadCase{"NothingNear", "colour: blue\n",
                "1:1: colour: expected a known key, found \"colour\""},
        BadCase{"DuplicateKey", "udp:\n  data_port: 1\n  data_port: 2\n",
                "3:3: udp.data_port: expected each key once, found it again after line 2"},
        BadCase{"DuplicateSection", "udp:\n  data_port: 1\nudp:\n  data_port: 2\n",
                "3:1: udp: expected each key once, found it again after line 1"},
        BadCase{"Octal", "udp:\n  data_port: 02368\n",
                "2:14: udp.data_port: expected a whole number from 1 to 65535, found 02368 "
                "(leading zeros)"},
        BadCase{"NotANumber", "sensor:\n  max_range_m: .nan\n",
                "2:16: sensor.max_range_m: expected a number from 5 to 300 (m), found .nan (not "
                "finite)"},
        BadCase{"Infinite", "sensor:\n  max_range_m: -.inf\n",
                "2:16: sensor.max_range_m: expected a number from 5 to 300 (m), found -.inf (not "
                "finite)"},
        BadCase{"Overflow", "sensor:\n  max_range_m: 1e999\n",
                "2:16: sensor.max_range_m: expected a number from 5 to 300 (m), found 1e999"},
        BadCase{"OutOfRange", "udp:\n  data_port: 65536\n",
                "2:14: udp.data_port: expected a whole number from 1 to 65535, found 65536"},
        BadCase{"HugeInteger", "udp:\n  data_port: 99999999999999999999\n",
                "2:14: udp.data_port: expected a whole number from 1 to 65535, found "
                "99999999999999999999"},
        BadCase{"FractionForInteger", "udp:\n  data_port: 1.5\n",
                "2:14: udp.data_port: expected a whole number from 1 to 65535, found 1.5"},
        BadCase{"NumberInQuotes", "udp:\n  data_port: '1'\n",
                "2:14: udp.data_port: expected a whole number from 1 to 65535, found \"1\" (text "
                "in quotes)"},
        BadCase{"YesIsNotTrue", "realtime:\n  lock_memory: yes\n",
                "2:16: realtime.lock_memory: expected true or false, found yes"},
        BadCase{"UnknownChoice", "sensor:\n  model: vlp-16\n",
                "2:10: sensor.model: expected one of auto, vlp16, hdl64e, vlp32c, hdl32e, vls128, "
                "found vlp-16; did you mean vlp16?"},
        BadCase{"NoValue", "udp:\n  data_port:\n",
                "2:3: udp.data_port: expected a whole number from 1 to 65535, found nothing"},
        BadCase{"ListForNumber", "udp:\n  data_port: [1]\n",
                "2:14: udp.data_port: expected a whole number from 1 to 65535, found a list"},
        BadCase{"TextForList", "publish:\n  sinks: 127.0.0.1:9870\n",
                "2:10: publish.sinks: expected a list, each item HOST:PORT with an IPv4 address or "
                "localhost, found 127.0.0.1:9870"},
        BadCase{"BadItem", "publish:\n  sinks: [\"127.0.0.1:9870\", \"127.0.0.1:0\"]\n",
                "2:29: publish.sinks: expected a list, each item HOST:PORT with an IPv4 address or "
                "localhost, found \"127.0.0.1:0\""},
        BadCase{"ValueForSection", "udp: 5\n",
                "1:6: udp: expected a section of `key: value` lines, found 5"},
        BadCase{"ListOnTop", "- udp\n",
                "1:1: expected a section of `key: value` lines, found a list"},
        BadCase{"ListAsKey", "udp:\n  [1, 2]: 3\n",
                "2:3: udp: expected the name of a key, found a list"},
        BadCase{"TwoDocuments", "udp:\n---\nudp:\n",
                "3:1: expected one YAML document, found a second one"},
        BadCase{"BrokenYaml", "udp:\n  data_port: [1\n",
                "3:1: expected YAML, found: end of sequence flow not found"},
        BadCase{"Contradiction", "sensor:\n  min_range_m: 9\n  max_range_m: 8\n",
                "2:16: sensor.min_range_m: expected less than sensor.max_range_m (8), found 9"},
        // Half cells are kept within 20 m. With 100 m of range these are 120 m, or 1022 halves of
        // 0.2349 m.
        BadCase{"CellsTooSmallForTheMap", "odometry:\n  default:\n    cell_m: 0.234\n",
                "3:13: odometry.default.cell_m: expected at least 0.2349 with "
                "odometry.default.map_radius_m 100 and returns from up to 100 m (max_range_m), "
                "found 0.234"},
        BadCase{"MapTooWideForItsCells", "odometry:\n  default:\n    map_radius_m: 300\n",
                "3:19: odometry.default.cell_m: expected at least 0.5871 with "
                "odometry.default.map_radius_m 300 and returns from up to 100 m (max_range_m), "
                "found 0.5"},
        BadCase{"SinkIsTheRequestPort", "publish:\n  sinks: [\"localhost:9871\"]\n",
                "2:10: publish.sinks: expected other programs' ports, not lilod's own "
                "subscribe.port, found \"localhost:9871\""},
        BadCase{"SinkIsTheDataPort", "publish:\n  sinks: [\"127.0.0.1:2368\"]\n",
                "2:10: publish.sinks: expected other programs' ports, not lilod's own "
                "udp.data_port, found \"127.0.0.1:2368\""},
        BadCase{
            "AllAtOnce", "udp:\n  data_port: 0\n  nonsense_here: 1\nrealtime:\n  ring_slots: 1\n",
            "2:14: udp.data_port: expected a whole number from 1 to 65535, found 0\n"
            "3:3: udp.nonsense_here: expected a known key, found \"nonsense_here\"\n"
            "5:15: realtime.ring_slots: expected a whole number from 3 to 64 (scans), found 1"}),
    [](const auto& test) { return test.param.name; });

TEST(LoadConfig, HostileTextsNeverCrash) {
  std::string deep(20000, '[');
  for (const std::string& text :
       {std::string("\0\0\0", 3), std::string("\xff\xfe\x00", 3), deep, std::string("a: &x [*x]\n"),
        std::string("udp: &u\n  data_port: *u\n"), std::string("<<: {udp: 1}\n"),
        std::string("%YAML 9.9\n---\n!!binary a: b\n"), std::string("? {a: b}\n: c\n"),
        std::string(2 << 20, '#')}) {
    EXPECT_NE(errors_of(text), "") << text.substr(0, 20);
  }
}

}  // namespace
}  // namespace lilo
