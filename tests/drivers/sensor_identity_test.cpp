// SPDX-License-Identifier: BSD-3-Clause
// The product byte decides whose packets they are; a sensor that is not the configured one is
// refused by name, from the first packet on.
#include "drivers/sensor_identity.hpp"

#include "drivers/packet_source.hpp"
#include "tests/drivers/capture_file.hpp"
#include "tests/drivers/packets.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace lilo {
namespace {

using test::Outcome;
using test::TimedPacket;

std::vector<TimedPacket> packets_of(SensorModel model, int count = 200) {
  if (model == SensorModel::vlp16) return test::vlp16_packets(count, {});
  if (model == SensorModel::hdl64e)
    return test::hdl64e_packets(count, {.calibration = test::sample_calibration(true)});
  return test::row_packets(count, {.model = model});
}

Outcome build_as(SensorModel configured, const std::vector<TimedPacket>& packets) {
  SensorConfig config;
  config.model = configured;
  return test::build(packets, config);
}

constexpr std::array kModels{SensorModel::vlp16, SensorModel::hdl64e, SensorModel::vlp32c,
                             SensorModel::hdl32e, SensorModel::vls128};

TEST(SensorIdentity, EveryModelIsFoundAndEveryOtherRefusedByName) {
  for (const SensorModel sent : kModels) {
    const auto packets = packets_of(sent);
    for (const SensorModel configured : kModels) {
      const Outcome out = build_as(configured, packets);
      const bool same = sent == configured;
      EXPECT_EQ(out.counts.data_packets, same ? 200U : 0U);
      EXPECT_EQ(out.counts.wrong_sensor_packets, same ? 0U : 200U);
      EXPECT_EQ(out.counts.malformed_packets, 0U);
      EXPECT_EQ(out.status.refused.packets, same ? 0U : 200U);
      EXPECT_EQ(out.status.refused.model, same ? SensorModel::automatic : sent);
    }
    const Outcome out = build_as(SensorModel::automatic, packets);
    EXPECT_EQ(out.status.model, sent);
    EXPECT_EQ(out.counts.data_packets, 200U);
  }
}

TEST(SensorIdentity, NamesWhatItRefuses) {
  const auto name = [](SensorModel configured, std::vector<TimedPacket> packets, int product) {
    if (product >= 0)
      for (TimedPacket& p : packets) p.bytes[1205] = static_cast<std::byte>(product);
    return build_as(configured, packets).status.refused.name();
  };
  const auto vlp16 = packets_of(SensorModel::vlp16, 3);
  EXPECT_EQ(name(SensorModel::hdl64e, vlp16, -1), "VLP-16 (product byte 0x22)");
  EXPECT_EQ(name(SensorModel::vlp16, vlp16, 0x28), "VLP-32C (product byte 0x28)");
  EXPECT_EQ(name(SensorModel::vlp16, vlp16, 0x21), "HDL-32E (product byte 0x21)");
  EXPECT_EQ(name(SensorModel::vlp16, vlp16, 0x23), "VLP-32A or VLP-32B (product byte 0x23)");
  EXPECT_EQ(name(SensorModel::vlp16, packets_of(SensorModel::hdl64e, 3), -1), "HDL-64E");
  EXPECT_EQ(name(SensorModel::automatic, vlp16, 0x77), "unknown sensor (product byte 0x77)");
  EXPECT_EQ(name(SensorModel::automatic, vlp16, -1), "");
}

// One public VLP-16 capture carries the HDL-32E's byte.
TEST(SensorIdentity, AWrongByteCanBeIgnored) {
  auto packets = test::vlp16_packets(170, {});
  const Outcome right = test::build(packets);
  for (TimedPacket& p : packets) p.bytes[1205] = std::byte{0x21};
  SensorConfig config;
  config.model = SensorModel::vlp16;
  EXPECT_EQ(test::build(packets, config).scans.size(), 0U);
  config.ignore_product_byte = true;
  const Outcome forced = test::build(packets, config);
  ASSERT_EQ(forced.scans.size(), right.scans.size());
  EXPECT_EQ(forced.counts.wrong_sensor_packets, 0U);
  EXPECT_EQ(forced.scans[0].returns.size(), right.scans[0].returns.size());
}

TEST(SensorIdentity, PacketsOfASecondModelBetweenAreLeftOut) {
  auto packets = packets_of(SensorModel::vlp16);
  const Outcome alone = test::build(packets);
  const auto others = packets_of(SensorModel::vlp32c, 20);
  for (std::size_t i = 0; i < others.size(); ++i) {
    TimedPacket other = others[i];
    const std::size_t at = 11 * i + 5;
    other.received_ns = packets[at].received_ns;
    packets.insert(packets.begin() + static_cast<std::ptrdiff_t>(at), other);
  }
  const Outcome mixed = test::build(packets);
  EXPECT_EQ(mixed.counts.wrong_sensor_packets, others.size());
  EXPECT_EQ(mixed.status.refused.model, SensorModel::vlp32c);
  ASSERT_EQ(mixed.scans.size(), alone.scans.size());
  for (std::size_t k = 0; k < alone.scans.size(); ++k)
    EXPECT_EQ(mixed.scans[k].returns.size(), alone.scans[k].returns.size());
}

// The wrong sensor comes first, tells the time as well and never stops: it must not be the one
// whose address is followed.
TEST(SensorIdentity, ARefusedSensorDoesNotKeepOutTheRightOne) {
  const auto right = packets_of(SensorModel::vlp16);
  const auto wrong = packets_of(SensorModel::vlp32c);
  ASSERT_EQ(right.size(), wrong.size());
  std::vector<TimedPacket> packets;
  for (std::size_t i = 0; i < right.size(); ++i) {
    TimedPacket other = wrong[i];
    other.received_ns = right[i].received_ns;
    TimedPacket time = test::position_packet(0, 0, "", other.received_ns);
    other.source_ipv4 = time.source_ipv4 = right[i].source_ipv4 + 1;
    packets.push_back(other);
    packets.push_back(time);
    packets.push_back(right[i]);
  }
  const Outcome out = build_as(SensorModel::vlp16, packets);
  EXPECT_EQ(out.counts.data_packets, right.size());
  EXPECT_EQ(out.status.sensor_ipv4, right[0].source_ipv4);
  EXPECT_EQ(out.counts.wrong_sensor_packets, 1U) << "before there was one to follow";
  EXPECT_EQ(out.counts.foreign_packets, 2 * (right.size() - 1));
  EXPECT_EQ(out.counts.packets_lost, 0U);
}

TEST(SensorIdentity, AnotherModelMayReplaceOneThatIsSilent) {
  auto packets = packets_of(SensorModel::vlp16);
  test::RowOptions later{.model = SensorModel::vls128};
  later.drive.start_received_ns = packets.back().received_ns + 3'000'000'000;
  for (const TimedPacket& p : test::row_packets(1500, later)) packets.push_back(p);
  const Outcome out = test::build(packets);
  EXPECT_EQ(out.status.model, SensorModel::vls128);
  EXPECT_EQ(out.counts.wrong_sensor_packets, 0U);
  EXPECT_EQ(out.scans.back().beams.ring_count, 128);
}

// The decoder's first table is that of a VLP-16, so that no packet makes it change to it.
TEST(SensorCalibration, AFileOverridesTheModelsOwn) {
  for (const SensorModel model : {SensorModel::vlp16, SensorModel::vlp32c}) {
    const SensorTable& table = *find_sensor(model);
    SCOPED_TRACE(table.name);
    Calibration calibration = built_in_calibration(table);
    for (LaserCorrection& laser : calibration.lasers) laser.vert_rad += 0.01;
    SensorConfig config;
    config.calibration_file = testing::TempDir() + "/override.yaml";
    ASSERT_TRUE(store_calibration(config.calibration_file, calibration));
    const auto packets = packets_of(model, 400);
    const Outcome own = test::build(packets), file = test::build(packets, config);
    ASSERT_FALSE(file.scans.empty());
    EXPECT_EQ(own.status.calibration, CalibrationOrigin::built_in);
    EXPECT_EQ(file.status.calibration, CalibrationOrigin::file);
    for (std::size_t ring = 0; ring < calibration.lasers.size(); ++ring)
      EXPECT_NEAR(file.scans[0].beams.elevation_rad[ring] - own.scans[0].beams.elevation_rad[ring],
                  0.01F, 1e-6F);
  }
}

// The corrections that an HDL-64E needs hold for others as well: here 10 cm of distance.
TEST(SensorCalibration, AFileCorrectsDistancesOfEveryModel) {
  Calibration calibration = built_in_calibration(*find_sensor(SensorModel::vlp32c));
  for (LaserCorrection& laser : calibration.lasers)
    laser = {.rot_rad = laser.rot_rad,
             .vert_rad = laser.vert_rad,
             .dist_m = 0.1,
             .vert_offset_m = laser.vert_offset_m};
  SensorConfig config;
  config.calibration_file = testing::TempDir() + "/longer.yaml";
  ASSERT_TRUE(store_calibration(config.calibration_file, calibration));
  const auto packets = packets_of(SensorModel::vlp32c, 400);
  const Outcome own = test::build(packets), longer = test::build(packets, config);
  ASSERT_FALSE(own.scans.empty());
  ASSERT_EQ(longer.scans.size(), own.scans.size());
  ASSERT_EQ(longer.scans[0].returns.size(), own.scans[0].returns.size());
  for (std::size_t i = 0; i < own.scans[0].returns.size(); i += 101) {
    const Return &a = own.scans[0].returns[i], &b = longer.scans[0].returns[i];
    EXPECT_NEAR(std::hypot(b.x_m - a.x_m, b.y_m - a.y_m, b.z_m - a.z_m), 0.1F, 1e-5F);
    EXPECT_EQ(a.intensity, b.intensity);
  }
}

TEST(SensorCalibration, MustHaveTheLasersOfTheConfiguredModel) {
  SensorConfig config;
  config.calibration_file = testing::TempDir() + "/of_64.yaml";
  ASSERT_TRUE(store_calibration(config.calibration_file, test::sample_calibration(true)));
  config.model = SensorModel::vls128;
  try {
    test::build({}, config);
    FAIL();
  } catch (const DriverError& e) {
    EXPECT_NE(std::string(e.what()).find("expected the 128 lasers of a VLS-128, found 64"),
              std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace lilo
