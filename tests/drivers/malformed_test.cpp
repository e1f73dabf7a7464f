// SPDX-License-Identifier: BSD-3-Clause
// Nothing a packet holds may harm: it is counted and left out.
#include "tests/drivers/packets.hpp"

#include <gtest/gtest.h>

#include <random>

namespace lilo {
namespace {

using test::build;
using test::Outcome;
using test::TimedPacket;

// Five turns' packets with one of them replaced.
Outcome with(const TimedPacket& packet, const SensorConfig& config = {}) {
  auto packets = test::vlp16_packets(170, {});
  TimedPacket timed = packet;
  timed.received_ns = packets[60].received_ns;
  packets[60] = timed;
  return build(packets, config);
}

void expect_left_out(const Outcome& out) {
  EXPECT_EQ(out.counts.malformed_packets, 1U);
  EXPECT_EQ(out.counts.data_packets, 169U);
  EXPECT_EQ(out.counts.packets_lost, 1U);
  ASSERT_EQ(out.scans.size(), 2U);
  EXPECT_EQ(out.scans[0].packets.lost, 1U);
  EXPECT_EQ(out.scans[1].packets.lost, 0U);
}

TimedPacket good() { return test::vlp16_packets(1, {})[0]; }

TEST(Malformed, WrongSizes) {
  for (const std::size_t size : {0U, 1U, 512U + 1U, 1205U, 1207U, 1500U}) {
    TimedPacket packet = good();
    packet.bytes.resize(size);
    expect_left_out(with(packet));
  }
}

TEST(Malformed, WrongFlagInAnyBlock) {
  for (std::size_t block = 0; block < 12; ++block) {
    TimedPacket packet = good();
    packet.bytes[100 * block] = std::byte{0x12};
    expect_left_out(with(packet));
  }
}

TEST(Malformed, ImpossibleAzimuth) {
  for (const int azimuth : {36000, 65535}) {
    TimedPacket packet = good();
    packet.bytes[702] = static_cast<std::byte>(azimuth & 0xFF);
    packet.bytes[703] = static_cast<std::byte>(azimuth >> 8);
    expect_left_out(with(packet));
  }
}

TEST(Malformed, ImpossibleStamp) {
  TimedPacket packet = good();
  for (std::size_t i = 0; i < 4; ++i) packet.bytes[1200 + i] = std::byte{0xFF};
  expect_left_out(with(packet));
}

TEST(Malformed, APositionPacketOnTheDataPort) {
  // It would set the clock by GPS if it were believed.
  TimedPacket packet =
      test::position_packet(1'000'000'000, 2, test::gprmc(9, 16, 40, 14, 5, 2024), 0);
  packet.port = 2368;
  TimedPacket zeros = packet;
  zeros.bytes.assign(512, std::byte{0});
  for (const TimedPacket& wrong : {packet, zeros}) {
    const Outcome out = with(wrong);
    expect_left_out(out);
    EXPECT_EQ(out.counts.position_packets, 0U);
    EXPECT_EQ(out.status.clock, ClockSource::host);
  }
}

TEST(Malformed, ADataPacketOnThePositionPort) {
  TimedPacket packet = test::vlp16_packets(170, {})[60];
  packet.port = 8308;
  expect_left_out(with(packet));
}

TEST(Malformed, ThePositionPortIsTheConfiguredOne) {
  TimedPacket packet =
      test::position_packet(1'000'000'000, 2, test::gprmc(9, 16, 40, 14, 5, 2024), 0);
  SensorConfig config;
  config.position_port = 4000;
  EXPECT_EQ(with(packet, config).counts.position_packets, 0U);
  packet.port = 4000;
  const Outcome out = with(packet, config);
  EXPECT_EQ(out.counts.position_packets, 1U);
  EXPECT_EQ(out.counts.malformed_packets, 0U);
}

TEST(Malformed, OldFirmwareIsTakenWhenTheModelIsConfigured) {
  auto packets = test::vlp16_packets(170, {});
  for (TimedPacket& packet : packets) packet.bytes[1204] = packet.bytes[1205] = std::byte{0};
  EXPECT_EQ(build(packets).counts.wrong_sensor_packets, 170U);
  SensorConfig config;
  config.model = SensorModel::vlp16;
  const Outcome out = build(packets, config);
  EXPECT_EQ(out.counts.malformed_packets, 0U);
  EXPECT_EQ(out.scans.size(), 2U);
}

TEST(Malformed, AStreamOfNoise) {
  std::mt19937 random(11);
  auto packets = test::vlp16_packets(170, {});
  for (TimedPacket& packet : packets)
    for (std::size_t i = 4; i < packet.bytes.size(); ++i)
      if (i % 100 >= 4 || random() % 8 == 0) packet.bytes[i] = static_cast<std::byte>(random());
  const Outcome out = build(packets);
  const DriverCounts& c = out.counts;
  EXPECT_EQ(c.data_packets + c.malformed_packets + c.wrong_sensor_packets, 170U);
}

}  // namespace
}  // namespace lilo
