// SPDX-License-Identifier: BSD-3-Clause
// Against what others counted: the real capture by independent programs, the simulated one by the
// simulator that lost the packets.
#include "tests/drivers/data_dir.hpp"
#include "tests/tools/temporary_file.hpp"
#include "tools/info/info_report.hpp"
#include "tools/sim/simulate.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>

namespace lilo {
namespace {

using Json = nlohmann::json;

RecordingInfo read_info(const std::string& path) {
  const auto source = open_scans(path, {});
  return read_recording(*source, [](const Scan&) {});
}

struct Revolution {
  double start_s = 0.0;
  std::uint32_t lost = 0;
};

// revs.csv: index,t_start,t_mid,t_end,points,gap
std::vector<Revolution> read_revolutions(const std::string& path) {
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  std::vector<Revolution> revolutions;
  while (std::getline(in, line)) {
    const std::size_t start = line.find(',') + 1;
    revolutions.push_back({std::stod(line.substr(start)), static_cast<std::uint32_t>(std::stoul(
                                                              line.substr(line.rfind(',') + 1)))});
  }
  return revolutions;
}

class SimulatedCapture : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    options_.world = "corridor";
    options_.motion.duration_s = 4.0;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  RecordingInfo make() {
    summary_ = sim::simulate(options_, folder_, [](double) {});
    return read_info(capture());
  }
  [[nodiscard]] std::string capture() const { return folder_ / "data.pcap"; }

  std::filesystem::path folder_;
  sim::SimOptions options_;
  sim::SimSummary summary_;
};

TEST(Info, RealCaptureHoldsWhatOthersFound) {
  const char* const capture = "real/vlp16_single_gps.pcap";
  LILO_NEED_DATA(capture);
  const RecordingInfo info = read_info(test::data_path(capture));
  const Json json = Json::parse(to_json("real", info));
  EXPECT_EQ(json["link_type"], "EN10MB");
  EXPECT_EQ(json["sensor"]["model"], "vlp16");
  EXPECT_EQ(json["sensor"]["product_id"], 0x22);
  EXPECT_EQ(json["sensor"]["return_modes"], Json::array({"strongest"}));
  EXPECT_NEAR(json["sensor"]["rpm"]["median"], 600.0, 6.0);
  EXPECT_EQ(json["calibration"]["origin"], "built_in");
  EXPECT_EQ(json["packets"]["data"], 293);
  EXPECT_EQ(json["packets"]["position"], 57);
  EXPECT_EQ(json["packets"]["lost"], 0);
  EXPECT_EQ(json["scans"]["complete"], 3);
  EXPECT_EQ(json["clock_scans"]["gps"], 3);
  EXPECT_TRUE(json["losses"].empty());
  EXPECT_NEAR(static_cast<double>(info.received.last_ns - info.received.first_ns) * 1e-9, 0.388,
              0.001);
  const std::string text = to_text("real", info);
  EXPECT_NE(text.find("2016-01-21 08:18:02"), std::string::npos) << text;  // of its GPRMC
  EXPECT_NE(text.find("VLP-16, strongest return"), std::string::npos) << text;
  EXPECT_NE(text.find("frames of Ethernet"), std::string::npos) << text;
}

TEST(Info, KittiFolderIsADataSet) {
  const char* const folder = "real/kitti_00";
  LILO_NEED_DATA(folder);
  const RecordingInfo info = read_info(test::data_path(folder));
  std::uint64_t files = 0;
  for (const auto& item :
       std::filesystem::directory_iterator(test::data_path(folder) + "/velodyne"))
    files += item.path().extension() == ".bin" ? 1U : 0U;
  EXPECT_EQ(info.scans, files);
  EXPECT_LE(std::ranges::count(to_text("kitti", info), '\n'), 5);
}

TEST_F(SimulatedCapture, LossesAreThoseOfTheSimulatorAndAtTheirTimes) {
  options_.faults.bursts_per_minute = 180.0;
  options_.faults.burst_packets = 40;
  options_.faults.loss = 0.002;
  const RecordingInfo info = make();
  ASSERT_GT(summary_.faults.lost, 80U);
  EXPECT_EQ(info.driver_counts.packets_lost, summary_.faults.lost);
  EXPECT_EQ(info.driver_counts.data_packets, summary_.packets_sent - summary_.faults.lost);
  EXPECT_EQ(info.driver_counts.position_packets, summary_.position_packets);

  std::uint64_t in_scans = 0;
  for (const ScanLoss& loss : info.losses) in_scans += loss.packets;
  EXPECT_EQ(in_scans + info.lost_outside_scans, summary_.faults.lost);

  const double capture_s = static_cast<double>(options_.start_utc_ns) * 1e-9;
  std::size_t found = 0;
  for (const Revolution& revolution : read_revolutions(folder_ / "revs.csv")) {
    if (revolution.lost < 3) continue;  // a packet on the cut may count for either revolution
    const auto loss = std::ranges::find_if(info.losses, [&](const ScanLoss& l) {
      return std::abs(static_cast<double>(l.start_ns) * 1e-9 - revolution.start_s) < 0.05;
    });
    ASSERT_NE(loss, info.losses.end()) << revolution.start_s;
    EXPECT_NEAR(loss->packets, revolution.lost, 1.0);
    EXPECT_NEAR(loss->after_s, revolution.start_s - capture_s, 0.05);
    ++found;
  }
  EXPECT_GE(found, 2U);
}

TEST_F(SimulatedCapture, ManyLossesStillFitOnOneScreen) {
  options_.faults.loss = 0.05;
  options_.faults.duplicates = 0.01;
  options_.faults.reorder = 0.01;
  options_.faults.garbage = 0.01;
  const RecordingInfo info = make();
  ASSERT_GT(info.losses.size(), 20U);
  const std::string text = to_text(capture(), info);
  EXPECT_LE(std::ranges::count(text, '\n'), 24) << text;
  EXPECT_EQ(Json::parse(to_json(capture(), info))["losses"].size(), info.losses.size());
}

TEST_F(SimulatedCapture, Hdl64eTellsItsTableAndModel) {
  options_.sensor.sensor = sim::Sensor::hdl64_s2;
  options_.motion.duration_s = 2.0;
  const Json json = Json::parse(to_json("hdl", make()));
  EXPECT_EQ(json["sensor"]["model"], "hdl64e");
  EXPECT_NEAR(json["sensor"]["packet_period_us"], 288.0, 0.5);  // S2: 6 shots of 48 us
  EXPECT_EQ(json["sensor"]["rings"], 64);
  EXPECT_EQ(json["calibration"]["origin"], "packets");
}

TEST_F(SimulatedCapture, Hdl64eLosesNothingByMeasuringItsTimingAgainAfterARestart) {
  options_.sensor.sensor = sim::Sensor::hdl64_s2;
  options_.sensor.gps = false;  // its clock starts at 0 again
  options_.motion.duration_s = 2.5;
  options_.faults.restart_at_s = 1.0;
  options_.faults.restart_gap_s = 0.5;
  const RecordingInfo info = make();
  EXPECT_EQ(info.driver_counts.sensor_restarts, 1U);
  EXPECT_EQ(info.driver_counts.packets_lost, 0U);  // what a silent sensor does not send
  EXPECT_EQ(info.driver_counts.data_packets, summary_.packets_sent - summary_.faults.lost);
}

TEST_F(SimulatedCapture, BrokenEndIsToldWithWhatCameBefore) {
  (void)make();
  std::filesystem::resize_file(capture(), std::filesystem::file_size(capture()) / 2);
  const RecordingInfo info = read_info(capture());
  EXPECT_NE(info.failure, "");
  EXPECT_GT(info.scans, 15U);
  EXPECT_EQ(Json::parse(to_json(capture(), info))["failure"], info.failure);
}

}  // namespace
}  // namespace lilo
