// SPDX-License-Identifier: BSD-3-Clause
#include "core/odometry.hpp"
#include "drivers/scan_source.hpp"
#include "tests/daemon/lilod_fixture.hpp"
#include "tests/daemon/schema.hpp"
#include "tests/daemon/text_of.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <vector>

namespace lilo {
namespace {

using nlohmann::json;

constexpr std::int64_t kHourNs = 3'600'000'000'000;

/// Whole records of a capture, up to `bytes` of it; all of it when LILO_LONG_TESTS is set. A pcap
/// is a header of 24 bytes and records of 16 bytes and what their third word says.
std::string beginning_of(const std::string& path, std::size_t bytes) {
  std::string text = text_of(path);
  if (std::getenv("LILO_LONG_TESTS") != nullptr) return text;
  std::size_t end = 24;
  while (end + 16 <= text.size()) {
    std::uint32_t captured = 0;
    std::memcpy(&captured, text.data() + end + 8, sizeof(captured));
    if (end + 16 + captured > std::min(bytes, text.size())) break;
    end += 16 + captured;
  }
  return text.substr(0, end);
}

/// The same file read as a file, scan by scan.
std::vector<Estimate> poses_of_file(const std::string& pcap, const SensorConfig& sensor) {
  const auto source = open_scans(pcap, sensor);
  Odometry odometry{OdometryConfig{}};
  std::vector<Estimate> poses;
  Scan scan;
  while (source->next(scan)) poses.push_back(odometry.process(scan));
  return poses;
}

Pose pose_of(const json& message) {
  const json& p = message["pose"]["position"];
  const json& q = message["pose"]["orientation"];
  return {Eigen::Quaterniond(q["w"].get<double>(), q["x"].get<double>(), q["y"].get<double>(),
                             q["z"].get<double>()),
          {p["x"].get<double>(), p["y"].get<double>(), p["z"].get<double>()}};
}

class EndToEnd : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const std::string folder = std::string(LILO_DATA_DIR) + '/' + GetParam();
    pcap_ = folder + "/data.pcap";
    // Without its file the HDL-64E's table would take 4 s of packets to collect.
    if (folder.find("hdl64") != std::string::npos) calibration_ = folder + "/calibration.yaml";
    if (!std::filesystem::exists(pcap_)) GTEST_SKIP() << pcap_ << " is not here";
  }
  std::string pcap_, calibration_;
};

// Issue 2: fed at sensor speed over loopback, no packet and no scan is lost, and every pose is that
// of the file to 1e-6 m and 1e-6 rad.
TEST_P(EndToEnd, PosesAreThoseOfTheFile) {
  const TemporaryFile slice("slice.pcap", beginning_of(pcap_, 10'000'000));
  const std::vector<Estimate> expected =
      poses_of_file(slice.path(), {.calibration_file = calibration_});
  ASSERT_GT(expected.size(), 10U);

  // Slots enough for a test machine that has other things to do; nothing may be dropped here.
  Lilod lilod("realtime:\n  ring_slots: 64\n", {}, "calibration_file: \"" + calibration_ + '"');
  ASSERT_TRUE(lilod.wait_ready());
  const std::string lilo = LILO_BIN_DIR "/lilo";
  ChildProcess replay({lilo, "replay", slice.path(), "--speed", kUnderTsan ? "0.2" : "1",
                       "--data-port", std::to_string(lilod.data_port()), "--position-port",
                       std::to_string(lilod.position_port())});
  const json schema = protocol_schema();
  std::vector<json> messages;
  // Health goes on being sent when no pose comes any more.
  constexpr std::chrono::seconds kPatience(5);
  auto give_up_at = std::chrono::steady_clock::now() + kPatience;
  while (messages.size() < expected.size() && std::chrono::steady_clock::now() < give_up_at) {
    const auto datagram = lilod.sink().receive(kPatience);
    if (!datagram) break;
    EXPECT_LE(datagram->size(), 1200U);
    const json message = json::parse(*datagram);
    EXPECT_EQ(violations(schema, message), std::vector<std::string>{});
    if (!message.contains("pose")) continue;
    messages.push_back(message);
    give_up_at = std::chrono::steady_clock::now() + kPatience;
  }
  EXPECT_EQ(replay.wait(std::chrono::seconds(60)), 0) << replay.standard_error();
  EXPECT_EQ(lilod.stop(), 0);
  ASSERT_EQ(messages.size(), expected.size()) << lilod.process().standard_error();

  double moved_m = 0.0;
  for (std::size_t k = 0; k < messages.size(); ++k) {
    const json& message = messages[k];
    EXPECT_EQ(message["seq"], k);
    EXPECT_EQ(message["session"], messages[0]["session"]);
    EXPECT_EQ(message["pose"]["lost_packets"], 0);
    const Pose pose = pose_of(message);
    const Pose error = pose.inverse() * expected[k].T_odom_sensor;
    EXPECT_LT(error.translation_m.norm(), 1e-6) << k;
    EXPECT_LT(so3_log(error.rotation.normalized()).norm(), 1e-6) << k;
    // Without a GPS fix only the place in the hour comes from the sensor.
    const std::int64_t stamp_ns =
        message["pose"]["stamp"]["sec"].get<std::int64_t>() * 1'000'000'000 +
        message["pose"]["stamp"]["nsec"].get<std::int64_t>();
    EXPECT_EQ((stamp_ns - expected[k].stamp_ns) % kHourNs, 0) << k;
    moved_m = std::max(moved_m, pose.translation_m.norm());
  }
  EXPECT_GT(moved_m, 1.0) << "the comparison says nothing when all poses are the identity";
}

INSTANTIATE_TEST_SUITE_P(Loopback, EndToEnd, testing::Values("sim_vlp16_town", "sim_hdl64_town"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace lilo
