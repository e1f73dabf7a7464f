// SPDX-License-Identifier: BSD-3-Clause
// What is lost, doubled, swapped or wrong on the way must be counted and must not bend a scan.
#include "tests/drivers/packets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace lilo {
namespace {

using test::build;
using test::Outcome;
using test::Room;
using test::TimedPacket;
using test::vlp16_packets;

constexpr double kDeg = std::numbers::pi / 180.0;

// The first cut is 20 degrees on, in the fifth packet: scan 0 is packets 4 to 79, and so on.
std::vector<TimedPacket> four_turns() { return vlp16_packets(320, {}); }

void drop(std::vector<TimedPacket>& packets, int first, int count) {
  packets.erase(packets.begin() + first, packets.begin() + first + count);
}

void expect_no_ghosts(const Outcome& out) {
  for (const Scan& scan : out.scans) {
    std::int32_t before_ns = 0;
    for (const Return& r : scan.returns) {
      ASSERT_GE(r.t_ns, before_ns);
      before_ns = r.t_ns;
      ASSERT_LT(Room::distance_to_surface_m(r), 0.002);
      // Azimuth and time of a firing belong together: a return of another turn would not fit.
      const double swept_deg = static_cast<double>(r.t_ns) * 3600e-9;
      const double azimuth_deg = -static_cast<double>(r.azimuth_rad) / kDeg;
      const double first_deg = -static_cast<double>(scan.returns.front().azimuth_rad) / kDeg -
                               scan.returns.front().t_ns * 3600e-9;
      ASSERT_NEAR(std::remainder(azimuth_deg - first_deg - swept_deg, 360.0), 0.0, 0.02);
    }
  }
}

TEST(Assembly, AllPacketsThereNothingToReport) {
  const Outcome out = build(four_turns());
  ASSERT_EQ(out.scans.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const Scan& scan = out.scans[i];
    EXPECT_EQ(scan.index, i);
    EXPECT_TRUE(scan.complete);
    EXPECT_EQ(scan.packets.lost, 0U);
    EXPECT_EQ(scan.packets.expected, scan.packets.received);
    EXPECT_NEAR(static_cast<double>(scan.coverage_rad), 2 * std::numbers::pi, 1e-5);
    EXPECT_EQ(scan.hole_width_rad, 0.0F);
  }
  expect_no_ghosts(out);
}

TEST(Assembly, OneLostPacketIsCountedAndItsHoleMarked) {
  auto packets = four_turns();
  drop(packets, 30, 1);  // begins 340 + 30 * 4.778 = 123.3 degrees
  const Outcome out = build(packets);
  ASSERT_EQ(out.scans.size(), 4U);
  EXPECT_EQ(out.counts.packets_lost, 1U);
  const Scan& scan = out.scans[0];
  EXPECT_EQ(scan.packets.lost, 1U);
  EXPECT_EQ(scan.packets.expected, scan.packets.received + 1);
  EXPECT_NEAR(static_cast<double>(scan.hole_start_rad), -123.5 * kDeg, 0.7 * kDeg);
  EXPECT_NEAR(static_cast<double>(scan.hole_width_rad), 4.5 * kDeg, 0.6 * kDeg);
  EXPECT_NEAR(static_cast<double>(scan.coverage_rad), (360 - 4.5) * kDeg, 0.6 * kDeg);
  EXPECT_TRUE(scan.complete);  // the limit is 5 degrees
  EXPECT_EQ(out.scans[1].packets.lost, 0U);
  expect_no_ghosts(out);
}

TEST(Assembly, FiveLostPacketsMakeTheScanPartial) {
  auto packets = four_turns();
  drop(packets, 30, 5);  // 23.9 degrees
  const Outcome out = build(packets);
  ASSERT_EQ(out.scans.size(), 4U);
  EXPECT_EQ(out.counts.packets_lost, 5U);
  EXPECT_EQ(out.scans[0].packets.lost, 5U);
  EXPECT_FALSE(out.scans[0].complete);
  EXPECT_NEAR(static_cast<double>(out.scans[0].hole_width_rad), 23.7 * kDeg, 0.6 * kDeg);
  EXPECT_TRUE(out.scans[1].complete);
  expect_no_ghosts(out);
}

TEST(Assembly, ALostSectorMakesTheScanPartial) {
  auto packets = four_turns();
  drop(packets, 100, 19);  // 90.8 degrees in the second scan
  const Outcome out = build(packets);
  ASSERT_EQ(out.scans.size(), 4U);
  EXPECT_EQ(out.counts.packets_lost, 19U);
  EXPECT_EQ(out.counts.scans_partial, 1U);
  EXPECT_TRUE(out.scans[0].complete);
  EXPECT_FALSE(out.scans[1].complete);
  EXPECT_EQ(out.scans[1].packets.lost, 19U);
  EXPECT_NEAR(static_cast<double>(out.scans[1].hole_width_rad), 90.6 * kDeg, 0.6 * kDeg);
  EXPECT_TRUE(out.scans[2].complete);
  expect_no_ghosts(out);
}

TEST(Assembly, ALossAcrossTheCutIsSharedByBothScans) {
  auto packets = four_turns();
  drop(packets, 74, 11);  // 5.5 packets before the cut in packet 79, and as many after
  const Outcome out = build(packets);
  ASSERT_EQ(out.scans.size(), 4U);
  EXPECT_EQ(out.counts.packets_lost, 11U);
  EXPECT_EQ(out.scans[0].packets.lost + out.scans[1].packets.lost, 11U);
  EXPECT_NEAR(out.scans[0].packets.lost, 5.5, 1.0);
  EXPECT_FALSE(out.scans[0].complete);
  EXPECT_FALSE(out.scans[1].complete);
  EXPECT_EQ(out.scans[1].index, 1U);
  expect_no_ghosts(out);
}

TEST(Assembly, AWholeLostTurnLeavesAGapInTheIndex) {
  auto packets = four_turns();
  drop(packets, 60, 100);
  const Outcome out = build(packets);
  ASSERT_EQ(out.scans.size(), 3U);
  EXPECT_EQ(out.counts.packets_lost, 100U);
  EXPECT_EQ(out.scans[0].index, 0U);
  EXPECT_EQ(out.scans[1].index, 2U);
  EXPECT_EQ(out.scans[2].index, 3U);
  expect_no_ghosts(out);
}

TEST(Assembly, RandomLossIsCountedExactly) {
  auto packets = four_turns();
  std::mt19937 random(3);
  std::vector<TimedPacket> kept = {packets.front()};
  for (std::size_t i = 1; i + 1 < packets.size(); ++i)
    if (random() % 10 != 0) kept.push_back(packets[i]);
  kept.push_back(packets.back());
  const Outcome out = build(kept);
  EXPECT_EQ(out.counts.packets_lost, packets.size() - kept.size());
  expect_no_ghosts(out);
}

TEST(Assembly, DuplicatesAreIgnored) {
  auto packets = four_turns();
  packets.insert(packets.begin() + 40, packets[40]);
  packets.insert(packets.begin() + 60, packets[50]);  // again, ten packets later
  const Outcome out = build(packets);
  const Outcome clean = build(four_turns());
  ASSERT_EQ(out.scans.size(), 4U);
  EXPECT_EQ(out.counts.packets_duplicated, 2U);
  EXPECT_EQ(out.counts.packets_lost, 0U);
  EXPECT_EQ(out.scans[0].packets.duplicated, 2U);
  EXPECT_EQ(out.scans[0].returns.size(), clean.scans[0].returns.size());
}

TEST(Assembly, SwappedPacketsGiveTheSameScan) {
  auto packets = four_turns();
  std::swap(packets[40], packets[41]);
  std::swap(packets[50], packets[53]);
  const Outcome out = build(packets);
  const Outcome clean = build(four_turns());
  ASSERT_EQ(out.scans.size(), 4U);
  EXPECT_EQ(out.counts.packets_lost, 0U);
  EXPECT_EQ(out.counts.packets_reordered, 4U);  // 40; 51, 52 and 50 came after 53
  EXPECT_EQ(out.scans[0].packets.lost, 0U);
  EXPECT_TRUE(out.scans[0].complete);
  EXPECT_EQ(out.scans[0].hole_width_rad, 0.0F);
  ASSERT_EQ(out.scans[0].returns.size(), clean.scans[0].returns.size());
  for (std::size_t i = 0; i < clean.scans[0].returns.size(); ++i) {
    EXPECT_EQ(out.scans[0].returns[i].t_ns, clean.scans[0].returns[i].t_ns);
    EXPECT_EQ(out.scans[0].returns[i].x_m, clean.scans[0].returns[i].x_m);
  }
}

TEST(Assembly, PacketsSwappedAcrossTheCutAddNothingToTheNextScan) {
  auto packets = four_turns();
  std::swap(packets[79], packets[81]);
  const Outcome out = build(packets);
  ASSERT_EQ(out.scans.size(), 4U);
  EXPECT_EQ(out.counts.packets_lost, 0U);
  expect_no_ghosts(out);
}

std::uint64_t lost_in_scans(const Outcome& out) {
  std::uint64_t lost = 0;
  for (const Scan& scan : out.scans) lost += scan.packets.lost;
  return lost;
}

// 79 holds the cut, 78 lies before it: scan 0 is handed on without it.
TEST(Assembly, APacketLateForItsScanIsLostThereButNotInTotal) {
  auto packets = four_turns();
  const TimedPacket late = packets[78];
  packets.insert(packets.begin() + 81, late);
  packets.erase(packets.begin() + 78);
  const Outcome out = build(packets);
  ASSERT_EQ(out.scans.size(), 4U);
  EXPECT_EQ(out.scans[0].packets.lost, 1U);
  EXPECT_EQ(out.scans[1].packets.lost, 0U);
  EXPECT_EQ(out.counts.packets_lost, 0U);
  EXPECT_EQ(out.counts.packets_reordered, 1U);
  EXPECT_EQ(out.counts.packets_late, 1U);
}

TEST(Assembly, LossOfScansAndOfTotalAgreeWhateverTheOrder) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    auto packets = four_turns();
    // Nothing is disturbed before the first scan and after the last.
    std::size_t dropped = 0;
    for (std::size_t i = 285; i > 10; --i) {
      if (random() % 12 == 0) std::swap(packets[i], packets[i - 1 - random() % 8]);
    }
    for (std::size_t i = 285; i > 10; --i) {
      if (random() % 15 != 0) continue;
      packets.erase(packets.begin() + static_cast<std::ptrdiff_t>(i));
      ++dropped;
    }
    const Outcome out = build(packets);
    EXPECT_EQ(out.counts.packets_lost, dropped) << seed;
    EXPECT_EQ(lost_in_scans(out), out.counts.packets_lost + out.counts.packets_late) << seed;
    for (const Scan& scan : out.scans)
      EXPECT_EQ(scan.packets.expected, scan.packets.received + scan.packets.lost);
  }
}

// Found by fuzzing: stamps nearer to each other than packets can be.
TEST(Assembly, WaveringStampsKeepTheOrderOfFirings) {
  auto packets = four_turns();
  for (std::size_t i = 100; i < 110; ++i) {
    const std::uint32_t us = 1'000'132'710 + static_cast<std::uint32_t>(i - 100) * 700;
    for (std::size_t k = 0; k < 4; ++k)
      packets[i].bytes[1200 + k] = static_cast<std::byte>(us >> (8 * k) & 0xFFU);
  }
  for (std::size_t i = 200; i < 220; i += 2)
    packets[i].bytes[1200] =
        static_cast<std::byte>(std::to_integer<int>(packets[i].bytes[1200]) & 0xF0);
  const Outcome out = build(packets);
  EXPECT_EQ(out.counts.sensor_restarts, 0U);
  ASSERT_EQ(out.scans.size(), 4U);
  for (const Scan& scan : out.scans)
    EXPECT_TRUE(std::is_sorted(scan.returns.begin(), scan.returns.end(),
                               [](const Return& a, const Return& b) { return a.t_ns < b.t_ns; }));
}

TEST(Assembly, ARestartedSensorEndsTheScan) {
  auto packets = vlp16_packets(120, {});
  const auto again = vlp16_packets(200, {.start_azimuth_deg = 100,
                                         .start_past_hour_s = 2.5,
                                         .start_received_ns = 1'715'678'212'000'000'000});
  packets.insert(packets.end(), again.begin(), again.end());
  const Outcome out = build(packets);
  EXPECT_EQ(out.counts.sensor_restarts, 1U);
  EXPECT_EQ(out.counts.packets_lost, 0U);
  ASSERT_EQ(out.scans.size(), 3U);
  EXPECT_TRUE(out.scans[0].complete);
  EXPECT_FALSE(out.scans[1].complete);
  EXPECT_TRUE(out.scans[2].complete);
  EXPECT_GT(out.scans[2].start_ns, out.scans[1].end_ns);
  expect_no_ghosts(out);
}

TEST(Assembly, AStoppedMotorGivesNoScansAndNoEndlessOne) {
  auto packets = vlp16_packets(120, {});
  const auto still = vlp16_packets(1500, {.rpm = 0.0,
                                          .start_azimuth_deg = 340 + 120 * 4.777574,
                                          .start_past_hour_s = 1000.0 + 120 * 1327.104e-6});
  packets.insert(packets.end(), still.begin(), still.end());
  const Outcome out = build(packets);
  EXPECT_EQ(out.counts.stalls, 1U);
  ASSERT_EQ(out.scans.size(), 2U);
  EXPECT_FALSE(out.scans[1].complete);
  EXPECT_LT(out.scans[1].end_ns - out.scans[1].start_ns, 600'000'000);
}

TEST(Assembly, AChangedSpeedIsFollowed) {
  auto packets = vlp16_packets(154, {});
  const double end_deg = 340 + 154 * 24 * 55.296e-6 * 3600;
  const auto faster = vlp16_packets(
      100,
      {.rpm = 1200, .start_azimuth_deg = end_deg, .start_past_hour_s = 1000.0 + 154 * 1327.104e-6});
  packets.insert(packets.end(), faster.begin(), faster.end());
  const Outcome out = build(packets);
  EXPECT_EQ(out.counts.packets_lost, 0U);
  ASSERT_EQ(out.scans.size(), 4U);
  for (const Scan& scan : out.scans) EXPECT_TRUE(scan.complete);
  EXPECT_NEAR(static_cast<double>(out.scans[3].end_ns - out.scans[3].start_ns), 50e6, 1e5);
  EXPECT_NEAR(out.status.rpm, 1200, 5);
}

// No echo in a quarter of the turn: the packets still tell of it.
TEST(Assembly, ABlindSectorIsNoHole) {
  auto packets = four_turns();
  for (TimedPacket& packet : packets)
    for (std::size_t b = 0; b < 12; ++b) {
      const auto low = std::to_integer<int>(packet.bytes[100 * b + 2]);
      const auto high = std::to_integer<int>(packet.bytes[100 * b + 3]);
      if (low + 256 * high >= 9000) continue;
      std::fill_n(packet.bytes.begin() + static_cast<std::ptrdiff_t>(100 * b + 4), 96,
                  std::byte{0});
    }
  const Outcome out = build(packets);
  ASSERT_EQ(out.scans.size(), 4U);
  for (const Scan& scan : out.scans) {
    EXPECT_TRUE(scan.complete);
    EXPECT_NEAR(static_cast<double>(scan.returns.size()), 28'900 * 0.75, 60.0);
  }
}

TEST(Assembly, CutsAtTheConfiguredAzimuth) {
  for (const double cut_deg : {0.0, 90.0, 179.99, 270.0, 359.99}) {
    SensorConfig config;
    config.cut_azimuth_rad = cut_deg * kDeg;
    const Outcome out = build(four_turns(), config);
    ASSERT_GE(out.scans.size(), 3U);
    for (const Scan& scan : out.scans) {
      EXPECT_TRUE(scan.complete);
      const double first_deg = -static_cast<double>(scan.returns.front().azimuth_rad) / kDeg;
      const double past_cut = std::remainder(first_deg - cut_deg, 360.0);
      EXPECT_GE(past_cut, -0.006);
      EXPECT_LT(past_cut, 0.21);  // one firing sequence turns 0.199 degrees
    }
  }
}

TEST(Assembly, FollowsOneSensorOfTwo) {
  const auto mine = four_turns();
  auto other = vlp16_packets(320, {.start_azimuth_deg = 77.0, .start_past_hour_s = 2000.0});
  std::vector<TimedPacket> both;
  for (std::size_t i = 0; i < mine.size(); ++i) {
    both.push_back(mine[i]);
    other[i].source_ipv4 += 1;
    both.push_back(other[i]);
  }
  const Outcome out = build(both);
  EXPECT_EQ(out.counts.foreign_packets, 320U);
  EXPECT_EQ(out.counts.packets_lost, 0U);
  EXPECT_EQ(out.scans.size(), 4U);
  expect_no_ghosts(out);
}

}  // namespace
}  // namespace lilo
