// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/worlds/worlds_run.hpp"

#include "tests/tools/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

namespace lilo::worlds {
namespace {

namespace fs = std::filesystem;

/// A program in lilo's place that notes how it is called and copies what is there.
constexpr const char* kStandIn = R"(#!/bin/sh
here=$(dirname "$0")
echo "$@" >>"$here/calls"
if [ "$1" = sim ]; then
  : >"$2/data.pcap"
  cp "$here/truth.tum" "$2/gt_end.tum"
fi
while [ $# -gt 0 ]; do
  case $1 in
    --poses) cp "$here/poses.jsonl" "$2" || exit 3 ;;
    --stats) cp "$here/stats.json" "$2" || exit 3 ;;
  esac
  shift
done
)";

constexpr const char* kTruth =
    "1 0 0 0 0 0 0 1\n2 10 0 0 0 0 0 1\n3 20 0 0 0 0 0 1\n4 30 0 0 0 0 0 1\n";
constexpr const char* kStats =
    R"({"total_ms":{"p50":1.5,"p99":2.5},"peak_rss_mb":40.5,"tenths":{"map_size":[0,1,2,3,4,5,6,7,8,900]}})";

/// 0.1 m too far at every pose.
std::string poses() {
  std::string text;
  for (int k = 0; k < 4; ++k) {
    text += R"({"seq":)" + std::to_string(k) + R"(,"session":"a","pose":{"stamp":{"sec":)" +
            std::to_string(k + 1) + R"(,"nsec":0},"status":")" +
            (k == 0 ? "initializing" : "tracking") + R"(","position":{"x":)" +
            std::to_string(10.1 * k) +
            R"(,"y":0,"z":0},"orientation":{"x":0,"y":0,"z":0,"w":1}}})" + "\n";
  }
  return text;
}

struct Bench {
  TemporaryFolder folder;
  Settings settings;

  Bench() {
    folder.write("lilo", kStandIn);
    fs::permissions(folder.path() + "/lilo", fs::perms::owner_all);
    folder.write("truth.tum", kTruth);
    folder.write("stats.json", kStats);
    folder.write("poses.jsonl", poses());
    folder.write("config.yaml", "odometry:\n");
    folder.write("out/cells/keep", "");
    const std::string program = folder.path() + "/lilo";
    settings = {.variants = {{program, folder.path() + "/config.yaml"}},
                .studio = {program, folder.path() + "/no_velosim", folder.path() + "/recordings"},
                .out = folder.path() + "/out",
                .lengths_m = {10.0},
                .jobs = 2};
  }
  [[nodiscard]] std::vector<Outcome> run(const std::vector<std::uint64_t>& seeds,
                                         Source source = Source::sim) const {
    const WorldList list{
        {{.name = "park", .source = source, .sensor = "vlp16", .arguments = {"--world", "park"}}},
        seeds,
        {}};
    return run_worlds(drives_of(list, {Role::choose}, ""), settings);
  }
  /// How often the stand-in was called for `what`.
  [[nodiscard]] std::ptrdiff_t calls(const std::string& what) const {
    std::ifstream file(folder.path() + "/calls");
    return std::count(std::istream_iterator<std::string>(file), {}, what);
  }
};

TEST(Worlds, EveryDriveIsRecordedAndRun) {
  const Bench bench;
  const std::vector<Outcome> outcomes = bench.run({11, 12});
  ASSERT_EQ(outcomes.size(), 2U);
  EXPECT_EQ(bench.calls("sim"), 2);
  EXPECT_EQ(bench.calls("run"), 2);
  EXPECT_EQ(bench.calls("12"), 1) << "the seed";
  for (const Outcome& outcome : outcomes) {
    ASSERT_EQ(outcome.trouble, "");
    const Figures& figures = outcome.figures.at(0);
    EXPECT_EQ(figures.tracking_percent, 75.0);
    EXPECT_EQ(figures.initializing_percent, 25.0);
    EXPECT_EQ(figures.false_tracking, 0.0);
    EXPECT_TRUE(std::isnan(figures.nees)) << "no covariance was said";
    // A segment ends at the first pose more than 10 m on, two poses on: 0.2 m too far.
    EXPECT_NEAR(figures.t_percent, 2.0, 1e-6);
    // Errors -0.15, -0.05, 0.05, 0.15 once the means lie over each other.
    EXPECT_NEAR(figures.ate_m, std::sqrt(0.0125), 1e-6);
    EXPECT_EQ(figures.cpu_p99_ms, 2.5);
    EXPECT_EQ(figures.map_size, 900.0);
    EXPECT_EQ(figures.peak_rss_mb, 40.5);
  }
}

TEST(Worlds, WhatIsFinishedIsNotRunAgain) {
  Bench bench;
  (void)bench.run({11, 12});
  const std::vector<Outcome> again = bench.run({11, 12, 13});
  EXPECT_EQ(bench.calls("run"), 3) << "the third alone is new";
  EXPECT_NEAR(again[0].figures.at(0).t_percent, 2.0, 1e-6);
  fs::remove_all(bench.settings.studio.recordings);
  (void)bench.run({11, 12, 13});
  EXPECT_EQ(bench.calls("sim"), 3) << "a finished cell needs no recording";
}

TEST(Worlds, AnotherConfigurationOrBuildIsAnotherCell) {
  const Bench bench;
  (void)bench.run({11, 12});
  bench.folder.write("config.yaml", "odometry: {}\n");
  (void)bench.run({11, 12});
  EXPECT_EQ(bench.calls("run"), 4);
  bench.folder.write("lilo", std::string(kStandIn) + "# built anew\n");
  (void)bench.run({11, 12});
  EXPECT_EQ(bench.calls("run"), 6);
  EXPECT_EQ(bench.calls("sim"), 2) << "recordings are made once";
  bench.folder.write("lilo", kStandIn);
  (void)bench.run({11, 12});
  EXPECT_EQ(bench.calls("run"), 6) << "the first build's are still there";
}

TEST(Worlds, AreSkippedWhereTheirSimulatorIsAbsent) {
  const Bench bench;
  const std::vector<Outcome> outcomes = bench.run({11}, Source::velosim);
  EXPECT_TRUE(outcomes[0].skipped);
  EXPECT_EQ(outcomes[0].trouble,
            "no velosim at " + bench.folder.path() + "/no_velosim: --velosim PATH");
  bench.folder.write("recordings/11/park/data.pcap", "");
  bench.folder.write("recordings/11/park/gt_end.tum", kTruth);
  EXPECT_EQ(bench.run({11}, Source::velosim)[0].trouble, "") << "the recording itself will do";
}

TEST(Worlds, AFailureIsToldAndTriedAgain) {
  const Bench bench;
  fs::remove(bench.folder.path() + "/stats.json");
  const Outcome failed = bench.run({11}).at(0);
  EXPECT_FALSE(failed.skipped);
  EXPECT_NE(failed.trouble.find(".log: exit code 3: "), std::string::npos) << failed.trouble;
  EXPECT_NE(failed.trouble.find("stats.json"), std::string::npos) << failed.trouble;
  bench.folder.write("stats.json", kStats);
  EXPECT_EQ(bench.run({11}).at(0).trouble, "");
}

TEST(Worlds, ARecordingOfOtherArgumentsIsNotTaken) {
  const Bench bench;
  (void)bench.run({11});
  bench.folder.write("recordings/11/park/made_by.txt", "sim --world town --seed 11\n");
  bench.folder.write("lilo", std::string(kStandIn) + "# built anew\n");
  const std::string trouble = bench.run({11}).at(0).trouble;
  EXPECT_NE(trouble.find("expected 'sim --world park --seed 11', found 'sim --world town"),
            std::string::npos)
      << trouble;
}

}  // namespace
}  // namespace lilo::worlds
