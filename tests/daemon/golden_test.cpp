// SPDX-License-Identifier: BSD-3-Clause
#include "tests/daemon/lilod_fixture.hpp"
#include "tests/daemon/schema.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

/// Captures through the real daemon, and all it says of them field by field against files that
/// somebody has looked at. `golden_test --rebuild` writes them anew: look at `git diff` then.
namespace lilo {
namespace {

using nlohmann::json;
using std::chrono::seconds;

bool rebuild = false;

/// A drive of `lilo sim`: same options, same bytes.
struct Drive {
  const char* name;
  std::vector<std::string> options;
  bool calibration_file = false;
};

std::ostream& operator<<(std::ostream& out, const Drive& drive) { return out << drive.name; }

/// How far a number may lie from the golden one: wide enough for another compiler and for finer
/// tuning of the odometry, too narrow for a wrong unit, sign, frame or order. Others: equal.
double tolerance(const std::string& path) {
  const auto under = [&](const char* part) { return path.find(part) != std::string::npos; };
  if (under("/position/")) return 0.05;
  if (under("/orientation/")) return 0.005;
  if (under("/twist/linear/")) return 0.4;
  if (under("/twist/angular/")) return 0.1;
  if (path == "/timestamp") return 1e-6;
  return 0.0;
}

void compare(const json& golden, const json& actual, const std::string& path) {
  if (golden.is_number() && actual.is_number()) {
    EXPECT_LE(std::abs(golden.get<double>() - actual.get<double>()), tolerance(path))
        << path << ": expected " << golden << ", found " << actual;
  } else if (golden.is_structured() && golden.type() == actual.type()) {
    EXPECT_EQ(golden.size(), actual.size()) << path;
    for (const auto& [key, value] : golden.items()) {
      const json::json_pointer at("/" + key);
      const std::string inner = std::string(path).append("/").append(key);
      if (actual.contains(at)) {
        compare(value, actual[at], inner);
      } else {
        ADD_FAILURE() << inner << " is missing";
      }
    }
  } else {
    EXPECT_EQ(golden, actual) << path;
  }
}

/// What differs from run to run is masked, so that it must be there but may be anything; the
/// numbers of a covariance are only counted.
json masked(json message) {
  message["session"] = "*";
  if (message.contains("pose")) {
    message["pose"]["latency_ms"] = "*";
    if (message["pose"].contains("covariance")) message["pose"]["covariance"] = "*";
  }
  return message;
}

/// Of health, the counts that the capture alone decides.
json counts_of(const json& health) {
  const json& h = health["health"];
  json out{{"clock", h["clock"]}, {"packets", h["packets"]}, {"poses_sent", h["poses_sent"]}};
  for (const char* key : {"complete", "partial", "processed", "dropped"})
    out["scans"][key] = h["scans"][key];
  return out;
}

class Golden : public testing::TestWithParam<Drive> {
 protected:
  Golden() : folder_(testing::TempDir() + "lilo_golden_" + std::to_string(getpid())) {}
  ~Golden() override { std::filesystem::remove_all(folder_); }

  /// Poses one by one, then the counts.
  std::vector<json> conversation() {
    const Drive& drive = GetParam();
    const std::string lilo = LILO_BIN_DIR "/lilo";
    std::vector<std::string> sim{lilo, "sim", folder_, "--quiet"};
    sim.insert(sim.end(), drive.options.begin(), drive.options.end());
    EXPECT_EQ(run_to_end(sim).exit_code, 0);
    const std::string table =
        drive.calibration_file ? "calibration_file: " + folder_ + "/calibration.yaml" : "";
    Lilod lilod("realtime:\n  ring_slots: 64\n", {}, table.empty() ? "model: auto" : table);
    if (!lilod.wait_ready()) return {};
    ChildProcess replay({lilo, "replay", folder_ + "/data.pcap", "--data-port",
                         std::to_string(lilod.data_port()), "--position-port",
                         std::to_string(lilod.position_port())});
    EXPECT_EQ(replay.wait(seconds(60)), 0) << replay.standard_error();
    std::vector<json> poses;
    json counts;
    const auto take = [&](const json& message) {
      if (message.contains("pose")) poses.push_back(masked(message));
      if (message.contains("health")) counts = counts_of(message);
    };
    while (const auto message = next(lilod, seconds(10))) {
      take(*message);
      if (message->contains("health") && all_is_worked_off((*message)["health"])) break;
    }
    EXPECT_EQ(lilod.stop(), 0);  // the last health says all
    while (const auto message = next(lilod, std::chrono::milliseconds(100))) take(*message);
    poses.push_back(counts);
    return poses;
  }

 private:
  static std::optional<json> next(Lilod& lilod, std::chrono::milliseconds patience) {
    const auto datagram = lilod.sink().receive(patience);
    if (!datagram) return std::nullopt;
    json message = json::parse(*datagram);
    EXPECT_EQ(violations(protocol_schema(), message), std::vector<std::string>{}) << *datagram;
    return message;
  }

  static bool all_is_worked_off(const json& health) {
    const json& scans = health["scans"];
    return health["status"] == "silent" &&
           scans["processed"].get<int>() + scans["dropped"].get<int>() ==
               scans["complete"].get<int>() + scans["partial"].get<int>();
  }

  std::string folder_;
};

TEST_P(Golden, SaysWhatItSaid) {
  const std::string path = std::string(LILO_GOLDEN_DIR) + '/' + GetParam().name + ".jsonl";
  const std::vector<json> actual = conversation();
  ASSERT_GT(actual.size(), 5U);
  if (rebuild) {
    std::ofstream file(path);
    for (const json& message : actual) file << message.dump() << '\n';
    GTEST_SKIP() << path << " is written anew";
  }
  std::ifstream file(path);
  std::vector<json> golden;
  for (std::string line; std::getline(file, line);) golden.push_back(json::parse(line));
  ASSERT_EQ(golden.size(), actual.size());
  for (std::size_t k = 0; k < golden.size(); ++k) compare(golden[k], actual[k], "");
}

const Drive kDrives[] = {
    {"vlp16_street", {"--duration-s", "2.5", "--standstill-s", "0.3"}},
    {"vlp16_faults",
     {"--duration-s", "2.5", "--start-in-motion", "--loss", "0.01", "--duplicates", "0.02",
      "--reorder", "0.02", "--garbage", "0.02"}},
    {"hdl64_country",
     {"--sensor", "hdl64-s2", "--world", "country", "--duration-s", "1.3", "--start-in-motion"},
     true},
};
INSTANTIATE_TEST_SUITE_P(Drives, Golden, testing::ValuesIn(kDrives),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace lilo

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  lilo::rebuild = argc == 2 && std::string(argv[1]) == "--rebuild";
  if (argc > 1 && !lilo::rebuild) return 2;
  return RUN_ALL_TESTS();
}
