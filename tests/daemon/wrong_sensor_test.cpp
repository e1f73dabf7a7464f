// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/complaints.hpp"
#include "daemon/prometheus.hpp"
#include "tests/daemon/a_health.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <string>

namespace lilo {
namespace {

using nlohmann::json;

/// What health says of a sensor that is refused, as JSON and for Prometheus.
struct Refusal {
  SensorModel configured, followed;
  RefusedSensor refused;
  const char* complaint;
  const char* label;
};

constexpr auto kAuto = SensorModel::automatic;
constexpr std::array<Refusal, 7> kRefusals{
    {{SensorModel::vlp16,
      kAuto,
      {9, SensorModel::vlp32c, 0x28},
      "packets of a VLP-32C (product byte 0x28) refused, configured is VLP-16: set sensor.model",
      "VLP-32C"},
     {SensorModel::vlp16,
      kAuto,
      {9, SensorModel::hdl64e, 0},
      "packets of an HDL-64E refused, configured is VLP-16: set sensor.model",
      "HDL-64E"},
     {kAuto,
      SensorModel::hdl32e,
      {9, SensorModel::vlp16, 0x24},
      "packets of a Puck Hi-Res (product byte 0x24) refused, an HDL-32E is followed: use another "
      "port",
      "Puck Hi-Res"},
     {kAuto,
      kAuto,
      {9, kAuto, 0x07},
      "packets of an unknown sensor (product byte 0x07) refused: set sensor.model",
      "unknown sensor"},
     {kAuto,
      SensorModel::vlp16,
      {9, kAuto, 0x31},
      "packets of a Velarray (product byte 0x31) refused: lilod cannot read them",
      "Velarray"},
     {kAuto,
      SensorModel::vlp16,
      {9, kAuto, 0x77},
      "packets of an unknown sensor (product byte 0x77) refused, a VLP-16 is followed: use "
      "another port",
      "unknown sensor"},
     {SensorModel::vlp16,
      SensorModel::vlp16,
      {9, kAuto, 0x23},
      "packets of a VLP-32A or VLP-32B (product byte 0x23) refused: lilod cannot read them",
      "VLP-32A or VLP-32B"}}};

TEST(Health, NamesTheSensorThatIsRefusedAndWhatHelps) {
  for (const Refusal& c : kRefusals) {
    Health h = a_health();
    h.recent = {};
    h.recent[Fault::wrong_sensor_packets] = 5;
    h.driver.wrong_sensor_packets = 9;
    h.sensor.model = c.followed;
    h.sensor.configured = c.configured;
    h.sensor.refused = c.refused;
    JsonWriter out;
    const json m = json::parse(write_health("0123456789abcdef", h, out))["health"];
    EXPECT_EQ(m["complaints"], json::array({c.complaint}));
    EXPECT_EQ(m["packets"]["wrong_sensor"], 9);
    EXPECT_TRUE(m.contains("stages_ms")) << "there is room";
    std::string text;
    write_prometheus("0123456789abcdef", h, text);
    const auto has_line = [&](const std::string& line) {
      return text.find('\n' + line + '\n') != std::string::npos;
    };
    const std::string info = "lilo_sensor_refused_info{instance=\"front\",model=\"";
    EXPECT_TRUE(has_line(info + c.label + "\"} 1"));
    EXPECT_TRUE(has_line("lilo_complaint{instance=\"front\",kind=\"wrong_sensor\"} 1"));
    h.recent = {};
    write_prometheus("0123456789abcdef", h, text);
    EXPECT_EQ(text.find(info), std::string::npos) << "they have stopped";
    EXPECT_TRUE(has_line("lilo_complaint{instance=\"front\",kind=\"wrong_sensor\"} 0"));
    EXPECT_TRUE(complaints(h).empty());
  }
}

}  // namespace
}  // namespace lilo
