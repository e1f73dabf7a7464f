// SPDX-License-Identifier: BSD-3-Clause
#include "tools/reset/reset_request.hpp"
#include "tools/status/status_report.hpp"
#include "tools/status/status_words.hpp"
#include "tools/top/live_view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

namespace lilo {
namespace {

using nlohmann::json;

constexpr std::int64_t kNoon_ns = 1'700'049'600LL * 1'000'000'000;

json health(const std::string& status = "tracking", const json& complaints = json::array()) {
  return {{"v", "2.0"},
          {"timestamp", 1.0},
          {"session", "0123456789abcdef"},
          {"health",
           {{"status", status},
            {"complaints", complaints},
            {"uptime_s", 7512.0},
            {"rate_hz", 10.0},
            {"clock", "gps"},
            {"sensor_silent_s", 0.0},
            {"packets", {{"received", 990}, {"lost", 10}, {"kernel_dropped", 0}, {"malformed", 2}}},
            {"scans", {{"complete", 13}, {"partial", 1}, {"dropped", 0}}},
            {"latency_ms", {{"p50", 2.5}, {"p99", 3.5}, {"max", 4.5}}},
            {"realtime", {{"as_configured", true}, {"policy", "SCHED_FIFO"}, {"priority", 50}}}}}};
}

json pose(const std::string& status = "tracking") {
  return {{"v", "2.0"},
          {"timestamp", 1.0},
          {"session", "0123456789abcdef"},
          {"seq", 17},
          {"pose",
           {{"stamp", {{"sec", 1'700'049'600}, {"nsec", 250'000'000}}},
            {"frame_id", "odom"},
            {"child_frame_id", "velodyne"},
            {"status", status},
            {"position", {{"x", 1.25}, {"y", -2.0}, {"z", 0.0}}},
            {"orientation", {{"x", 0.0}, {"y", 0.0}, {"z", std::sqrt(0.5)}, {"w", std::sqrt(0.5)}}},
            {"twist",
             {{"linear", {{"x", 3.0}, {"y", 4.0}, {"z", 0.0}}},
              {"angular", {{"x", 0.0}, {"y", 0.0}, {"z", 0.0}}}}},
            {"latency_ms", 3.0},
            {"lost_packets", 0}}}};
}

std::string row(const StatusReport& report, const std::string& label) {
  for (const StatusRow& each : status_rows(report)) {
    if (each.label == label) return each.text;
  }
  return "no such row";
}

TEST(Status, SaysWhatTheDaemonSays) {
  const StatusReport report{"robot:9871", "lilod 0.1.0", health(), pose()};
  EXPECT_TRUE(is_good(report));
  EXPECT_EQ(row(report, "Daemon"), "lilod 0.1.0 at robot:9871, up 2 h 5 min");
  EXPECT_EQ(row(report, "Complaints"), "none");
  EXPECT_EQ(row(report, "Position"), "x 1.250, y -2.000, z 0.000 m");
  EXPECT_EQ(row(report, "Rotation"), "roll 0.00, pitch 0.00, yaw 90.00 deg");
  EXPECT_EQ(row(report, "Speed"), "5.00 m/s, turning 0.0 deg/s");
  EXPECT_EQ(row(report, "Last pose"), "number 17, 2023-11-15 12:00:00.250 UTC");
  EXPECT_EQ(row(report, "Packets"),
            "990 received, 10 lost (1 %), 0 dropped by the kernel, 2 malformed");
  EXPECT_EQ(row(report, "Sensor"), "stamps by GPS");
}

TEST(Status, SaysThatScansAreLevelled) {
  StatusReport report{"robot:9871", "lilod 0.1.0", health(), pose()};
  EXPECT_EQ(row(report, "Tilt"), "no such row");
  report.health["health"]["tilt_deg"] = 12.34;
  EXPECT_EQ(row(report, "Tilt"), "12.3 deg against the ground of the first scan, levelled");
}

TEST(Status, OnlyTrackingWithoutComplaintsIsGood) {
  EXPECT_FALSE(is_good({"", "", health("lost"), pose()}));
  EXPECT_FALSE(is_good({"", "", health("initializing"), nullptr}));
  EXPECT_FALSE(is_good({"", "", health("a new word"), pose()}));
  EXPECT_FALSE(is_good({"", "", health("tracking", {"packets lost"}), pose()}));
}

TEST(Status, WithoutAPoseSaysSo) {
  EXPECT_EQ(row({"", "", health("initializing"), nullptr}, "Last pose"), "none yet");
}

TEST(Status, JsonIsOneObject) {
  const json object = json::parse(to_json({"robot:1", "lilod 2", health(), pose()}));
  EXPECT_EQ(object["good"], true);
  EXPECT_EQ(object["lilod"], "robot:1");
  EXPECT_EQ(object["health"]["packets"]["lost"], 10);
  EXPECT_EQ(object["pose"]["position"]["x"], 1.25);
  EXPECT_FALSE(json::parse(to_json({"", "", health(), nullptr})).contains("pose"));
}

TEST(Status, DurationsAreForPeople) {
  EXPECT_EQ(duration_words(2.34), "2.3 s");
  EXPECT_EQ(duration_words(59.9), "59 s");
  EXPECT_EQ(duration_words(192.0), "3 min 12 s");
  EXPECT_EQ(duration_words(180000.0), "2 d 2 h");
}

std::ptrdiff_t lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

TEST(Top, TellsWhatChanged) {
  LiveView view("robot:9871", "lilod 0.1.0");
  view.take(health("tracking"), kNoon_ns);
  view.take(health("degraded", {"packets lost"}), kNoon_ns + 1'000'000'000);
  view.take(health("tracking"), kNoon_ns + 2'000'000'000);
  view.silence(5.0, kNoon_ns + 7'000'000'000);
  const std::string text = view.text(60, 100, Paint(false));
  EXPECT_NE(text.find("NO WORD for 5.0 s"), std::string::npos) << text;
  EXPECT_NE(text.find("Status          : unknown, was tracking\n"), std::string::npos) << text;
  EXPECT_NE(text.find("12:00:01        : packets lost"), std::string::npos) << text;
  EXPECT_NE(text.find("12:00:02        : no longer: packets lost"), std::string::npos) << text;
  EXPECT_NE(text.find("12:00:07        : no word from lilod"), std::string::npos) << text;
  view.take(pose(), kNoon_ns + 8'000'000'000);
  EXPECT_NE(view.text(60, 100, Paint(false)).find("lilod answers again"), std::string::npos);
}

// A window of any size: never more lines, never longer ones.
TEST(Top, FitsTheWindow) {
  LiveView view("robot:9871", "lilod 0.1.0");
  for (int k = 0; k < 50; ++k) {
    view.take(health(k % 2 == 0 ? "tracking" : "lost"), kNoon_ns + k);
    view.take(pose(), kNoon_ns + k);
  }
  for (const std::size_t rows : {1U, 2U, 10U, 24U, 100U}) {
    EXPECT_LE(lines(view.text(rows, 80, Paint(false))), static_cast<std::ptrdiff_t>(rows));
  }
  for (const std::size_t columns : {18U, 40U}) {
    std::istringstream narrow(view.text(60, columns, Paint(false)));
    for (std::string line; std::getline(narrow, line);) {
      // A bar is one column wide and three bytes long.
      if (line.find("latencies") == std::string::npos) {
        EXPECT_LE(line.size(), columns) << line;
      }
    }
  }
}

TEST(Top, BarsReachFromTheLowestToTheHighest) {
  EXPECT_EQ(bars({0.0, 1.0, 2.0}, 3), "▁▅█");
  EXPECT_EQ(bars({5.0, 1.0, 2.0}, 1), "█");
  EXPECT_EQ(bars({}, 10), "");
}

TEST(ResetRequest, AnglesAreAboutFixedAxes) {
  EXPECT_EQ(reset_request({}), json({{"reset", json::object()}}));
  const json request = reset_request({1.0, 2.0, 3.0, 90.0, 0.0, 90.0});
  const json q = request["reset"]["pose"]["orientation"];
  // Roll a quarter, then yaw a quarter about the fixed axes: all components are 0.5.
  for (const char* name : {"x", "y", "z", "w"}) EXPECT_NEAR(q[name].get<double>(), 0.5, 1e-12);
  EXPECT_EQ(request["reset"]["pose"]["position"]["z"], 3.0);
  EXPECT_THROW((void)reset_request({1.0, 2.0, 3.0, 4.0}), std::runtime_error);
}

}  // namespace
}  // namespace lilo
