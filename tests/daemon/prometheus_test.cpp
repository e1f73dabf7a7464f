// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/prometheus.hpp"

#include "tests/daemon/a_health.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace lilo {
namespace {

// Each count under its own name: a number that reached another's place would be found there.
TEST(Prometheus, NamesEveryCountOfTheDrivers) {
  Health h = a_health();
  h.packets_sent = 116;
  h.packets_not_sent = 117;
  h.driver = {.data_packets = 101,
              .position_packets = 102,
              .malformed_packets = 103,
              .packets_lost = 104,
              .packets_duplicated = 105,
              .packets_reordered = 106,
              .packets_late = 107,
              .packets_blind = 108,
              .scans_complete = 109,
              .scans_partial = 110,
              .sensor_restarts = 111,
              .stalls = 112,
              .foreign_packets = 113,
              .wrong_sensor_packets = 114,
              .waiting_packets = 115};
  static_assert(sizeof(DriverCounts) == 15 * sizeof(std::uint64_t), "name the new one here");
  std::string text;
  write_prometheus("0123456789abcdef", h, text);
  int expected = 101;
  for (const char* name :
       {"packets_received", "packets_position", "packets_malformed", "packets_lost",
        "packets_duplicated", "packets_reordered", "packets_late", "packets_blind",
        "scans_complete", "scans_partial", "sensor_restarts", "sensor_stalls", "packets_foreign",
        "packets_wrong_sensor", "packets_waiting", "packets_sent", "packets_not_sent"}) {
    const std::string line = "\nlilo_" + std::string(name) + "_total{instance=\"front\"} " +
                             std::to_string(expected++) + '\n';
    EXPECT_NE(text.find(line), std::string::npos) << line;
  }
}

// promtool's rules: HELP and TYPE before the samples, each metric once, counters end in _total,
// values are numbers.
TEST(Prometheus, FollowsTheTextFormat) {
  std::string text = "what was there before";
  write_prometheus("0123456789abcdef", a_health(), text);
  std::istringstream lines(text);
  const std::regex sample(R"(([a-z_]+)(\{([a-z]+="[^"\n]*",?)+\})? (-?[0-9.e+-]+))");
  std::set<std::string> declared;
  std::string current, type;
  int samples = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string hash, keyword, name;
    if (line[0] == '#') {
      words >> hash >> keyword >> name >> type;
      if (keyword != "TYPE") continue;
      EXPECT_TRUE(declared.insert(name).second) << line;
      EXPECT_EQ(type == "counter", name.ends_with("_total")) << line;
      current = name;
      continue;
    }
    std::smatch match;
    ASSERT_TRUE(std::regex_match(line, match, sample)) << line;
    EXPECT_EQ(match[1], current);
    EXPECT_NE(line.find("{instance=\"front\""), std::string::npos) << line;
    ++samples;
  }
  EXPECT_GT(samples, 40);
  // What issue 6 asks for by name.
  for (const char* part :
       {"lilo_packets_expected_total{X} 1003", "lilo_packets_kernel_dropped_total{X} ",
        "lilo_scans_partial_total{X} ", "lilo_ring_high_water_scans{X} ",
        "lilo_stage_seconds{X,stage=\"align\",quantile=\"0.99\"} 0.004",
        "lilo_latency_seconds{X,quantile=\"0.99\"} 0.0055", "lilo_major_faults_total{X} ",
        "lilo_worker_policy_info{X,policy=\"SCHED_FIFO\",priority=\"40\",cpus=\"1\"} 1",
        "lilo_clock_info{X,source=\"host\"} 1", "lilo_status_info{X,status=\"tracking\"} 1"}) {
    std::string line = '\n' + std::string(part);
    line.replace(line.find('X'), 1, "instance=\"front\"");
    EXPECT_NE(text.find(line), std::string::npos) << line;
  }
}

}  // namespace
}  // namespace lilo
