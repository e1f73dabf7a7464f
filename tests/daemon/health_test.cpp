// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/health.hpp"

#include "daemon/complaints.hpp"
#include "daemon/health_monitor.hpp"
#include "daemon/prometheus.hpp"
#include "daemon/recent_faults.hpp"
#include "tests/daemon/a_health.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace lilo {
namespace {

using nlohmann::json;

TEST(Health, SaysEverythingInOneDatagram) {
  JsonWriter out;
  const json m = json::parse(write_health("0123456789abcdef", a_health(), out));
  EXPECT_DOUBLE_EQ(m["timestamp"].get<double>(), 1700000000.5);
  EXPECT_FALSE(m.contains("pose"));
  const json& h = m["health"];
  EXPECT_EQ(h["status"], "tracking");
  EXPECT_EQ(h["instance"], "front");
  EXPECT_EQ(h["sensor"], json::parse(R"({"model":"vlp16","address":"192.168.1.201","rpm":600,)"
                                     R"("returns":"strongest"})"));
  EXPECT_EQ(h["packets"]["received"], 1000);
  EXPECT_EQ(h["latency_ms"]["p99"], 5.5);
  EXPECT_EQ(h["realtime"]["policy"], "SCHED_FIFO");
  EXPECT_EQ(h["complaints"], json::array({"packets lost"}));
  EXPECT_EQ(h["stages_ms"].size(), static_cast<std::size_t>(kStageCount));
}

// All counters at their widest, all complaints: what goes is the stages, then the last complaints,
// never the datagram.
TEST(Health, NeverOutgrowsTheDatagram) {
  Health h = a_health();
  const std::uint64_t huge = std::numeric_limits<std::uint32_t>::max() * std::uint64_t{1000};
  h.driver = {.data_packets = huge,
              .malformed_packets = huge,
              .packets_lost = huge,
              .packets_duplicated = huge,
              .packets_reordered = huge,
              .scans_complete = huge,
              .scans_partial = huge,
              .sensor_restarts = huge,
              .foreign_packets = huge,
              .wrong_sensor_packets = huge};
  h.source = {.kernel_dropped = huge, .receive_errors = huge};
  h.sensor.refused = {.packets = huge, .product_id = 0x23};
  h.instance = std::string(32, 'x');
  h.map_refused = h.clock_steps = huge;
  h.tilt_deg = 179.9;
  h.scans_processed = h.scans_dropped = h.poses_sent = h.poses_not_sent = h.send_errors = huge;
  h.worker_minor_faults = h.major_faults = huge;
  h.latency_ms = h.processing_ms = {12345.67, 12345.67, 12345.67};
  h.stages_ms.fill(h.latency_ms);
  h.tracking = TrackingStatus::degraded;
  h.sensor_silent_s = h.pose_age_s = 1e6;
  h.sensor.return_mode = ReturnMode::strongest;
  h.recent.counts.fill(huge);
  h.config_error = h.metrics_error = true;
  h.realtime.refusals = {"x"};
  JsonWriter out;
  const std::string_view text = write_health("0123456789abcdef", h, out);
  ASSERT_FALSE(text.empty());
  const json found = json::parse(text)["health"]["complaints"];
  EXPECT_EQ(complaints(h).size(), 1 + kFaultCount + 3) << "degraded, all faults, three states";
  ASSERT_GE(found.size(), 1U);
  EXPECT_EQ(found.back(), "more");
}

TEST(Health, ComplaintsAreEmptyWhenAllIsWell) {
  Health h = a_health();
  h.recent = {};
  EXPECT_TRUE(complaints(h).empty()) << "what was lost long ago is a count, no complaint";
}

std::vector<std::string> said(const Health& h) {
  std::vector<std::string> out;
  for (const Complaint complaint : complaints(h)) out.emplace_back(words(complaint));
  return out;
}

// What does not come through outranks what the last pose said.
TEST(Health, StatusIsThatOfNow) {
  using Words = std::vector<std::string>;
  Health h = a_health();
  h.recent = {};
  EXPECT_STREQ(status_word(h), "tracking");
  h.tracking = TrackingStatus::lost;
  EXPECT_STREQ(status_word(h), "lost");
  EXPECT_EQ(said(h), Words{"lost"});
  h.flow = Flow::no_packets;
  EXPECT_STREQ(status_word(h), "silent");
  EXPECT_EQ(said(h), Words{"sensor silent"});
  h.flow = Flow::no_scans;
  EXPECT_STREQ(status_word(h), "no_scans");
  EXPECT_EQ(said(h), Words{"no scans although packets come"});
  h.sensor = {.model = SensorModel::hdl64e};
  EXPECT_EQ(said(h), Words{"waiting for the calibration"}) << "that is the reason";
  h.flow = Flow::no_poses;
  h.sensor.calibration = CalibrationOrigin::packets;
  EXPECT_STREQ(status_word(h), "no_poses");
  EXPECT_EQ(said(h), Words{"no poses although scans come"});
}

TEST(Health, EveryComplaintHasWordsAndASlug) {
  std::set<std::string_view> all_words, slugs;
  for (std::size_t k = 0; k < kComplaintCount; ++k) {
    all_words.insert(words(static_cast<Complaint>(k)));
    slugs.insert(slug(static_cast<Complaint>(k)));
  }
  EXPECT_EQ(all_words.size(), kComplaintCount);
  EXPECT_EQ(slugs.size(), kComplaintCount);
  EXPECT_FALSE(all_words.contains("") || slugs.contains(""));
}

TEST(Health, SaysThatTheMapIsFullAndThatSocketsFail) {
  Health h = a_health();
  h.recent = {};
  h.map_refused = 17;
  h.source.receive_errors = 4;
  h.recent[Fault::map_refused] = 1;
  h.recent[Fault::receive_errors] = 1;
  JsonWriter out;
  const json m = json::parse(write_health("0123456789abcdef", h, out))["health"];
  EXPECT_EQ(m["map_refused"], 17);
  EXPECT_EQ(m["receive_errors"], 4);
  EXPECT_EQ(m["complaints"], json::array({"receive errors", "map full"}));
  std::string text;
  write_prometheus("0123456789abcdef", h, text);
  for (const char* line : {"lilo_map_refused_total{instance=\"front\"} 17",
                           "lilo_receive_errors_total{instance=\"front\"} 4",
                           "lilo_complaint{instance=\"front\",kind=\"map_full\"} 1",
                           "lilo_complaint{instance=\"front\",kind=\"packets_lost\"} 0"}) {
    EXPECT_NE(text.find('\n' + std::string(line) + '\n'), std::string::npos) << line;
  }
}

TEST(Health, SaysByHowMuchScansAreLevelled) {
  Health h = a_health();
  JsonWriter out;
  EXPECT_FALSE(
      json::parse(write_health("0123456789abcdef", h, out))["health"].contains("tilt_deg"));
  h.tilt_deg = 12.27;
  EXPECT_EQ(json::parse(write_health("0123456789abcdef", h, out))["health"]["tilt_deg"], 12.3);
  std::string text;
  write_prometheus("0123456789abcdef", h, text);
  EXPECT_NE(text.find("\nlilo_tilt_degrees{instance=\"front\"} 12.27\n"), std::string::npos)
      << text;
}

TEST(Health, SaysByHowMuchTheBeamsAreCorrected) {
  Health h = a_health();
  JsonWriter out;
  EXPECT_FALSE(json::parse(write_health("0123456789abcdef", h, out))["health"].contains("beams"));
  h.has_beams = true;
  h.beams_elevation_deg = 0.0931;
  h.beams_azimuth_deg = 0.0762;
  const json m = json::parse(write_health("0123456789abcdef", h, out))["health"];
  EXPECT_EQ(m["beams"], json::parse(R"({"elevation_deg":0.093,"azimuth_deg":0.076})"));
  std::string text;
  write_prometheus("0123456789abcdef", h, text);
  EXPECT_NE(text.find("\nlilo_beams_elevation_degrees{instance=\"front\"} 0.0931\n"),
            std::string::npos)
      << text;
}

TEST(RecentFaults, AreForgottenAfterTenSeconds) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  RecentFaults recent;
  FaultCounts totals;
  std::int64_t now_ns = 5 * kSecond;
  const auto after_a_second = [&] {
    now_ns += kSecond;
    return recent.see(totals, now_ns)[Fault::packets_lost];
  };
  totals[Fault::packets_lost] = 7;
  EXPECT_EQ(after_a_second(), 7U) << "lost before the first look";
  for (int k = 0; k < 9; ++k) EXPECT_EQ(after_a_second(), 7U) << k;
  after_a_second();
  EXPECT_EQ(after_a_second(), 0U);
  totals[Fault::packets_lost] = 5;
  EXPECT_EQ(after_a_second(), 0U) << "two of them came late";
  totals[Fault::packets_lost] = 10;
  EXPECT_EQ(after_a_second(), 3U) << "and another five";
}

TEST(InstanceName, IsThatOfTheFile) {
  EXPECT_EQ(instance_name("/etc/lilod/front.yaml"), "front");
  EXPECT_EQ(instance_name("my.robot.yaml"), "my.robot");
  EXPECT_EQ(instance_name("a\"b\n{}.yaml"), "a_b___");
  EXPECT_EQ(instance_name("/x/" + std::string(100, 'y') + ".yaml").size(), 32U);
}

TEST(RecentValues, QuantilesAreNearestRank) {
  RecentValues values;
  EXPECT_EQ(values.quantiles().max, 0.0);
  for (int k = 1; k <= 100; ++k) values.add(101 - k);
  EXPECT_EQ(values.quantiles().p50, 50.0);
  EXPECT_EQ(values.quantiles().p99, 99.0);
  EXPECT_EQ(values.quantiles().max, 100.0);
  for (std::size_t k = 0; k < RecentValues::kCapacity; ++k) values.add(7.0);
  EXPECT_EQ(values.quantiles().max, 7.0) << "old values are forgotten";
}

}  // namespace
}  // namespace lilo
