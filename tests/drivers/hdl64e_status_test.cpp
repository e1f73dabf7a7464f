// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/hdl64e_status.hpp"

#include "tests/drivers/packets.hpp"
#include "tests/drivers/same_calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

namespace lilo {
namespace {

using test::expect_same;
using test::HdlOptions;
using test::TimedPacket;

using Table = Hdl64eStatus::Table;

struct Status {
  std::uint8_t type, value;
};

// Type and value of each of `count` packets; the lap starts at packet `start`.
std::vector<Status> status_of(int count, HdlOptions options, int start = 0) {
  options.start_in_cycle = start;
  std::vector<Status> all;
  options.without_returns = true;
  for (const TimedPacket& packet : test::hdl64e_packets(count, options))
    all.push_back({std::to_integer<std::uint8_t>(packet.bytes[1204]),
                   std::to_integer<std::uint8_t>(packet.bytes[1205])});
  return all;
}

HdlOptions s3() { return {.calibration = test::sample_calibration(true), .s3 = true}; }
HdlOptions s2() { return {.calibration = test::sample_calibration(true), .s3 = false}; }

const std::vector<Status>& s3_laps() {
  static const auto laps = status_of(3 * 4160, s3());
  return laps;
}
const std::vector<Status>& s2_laps() {
  static const auto laps = status_of(2 * 4160, s2());
  return laps;
}

// Feeds statuses until one is not incomplete; how many that took, or -1.
int feed(Hdl64eStatus& status, const std::vector<Status>& all, std::size_t begin, bool is_s3,
         Table& result) {
  for (std::size_t i = begin; i < all.size(); ++i) {
    result = status.see(all[i].type, all[i].value, 0, is_s3);
    if (result != Table::incomplete) return static_cast<int>(i - begin) + 1;
  }
  return -1;
}

TEST(Hdl64eStatus, OneLapIsEnoughWhereverItStarts) {
  for (const std::size_t start : {0U, 1U, 7U, 9U, 13U, 14U, 100U, 2077U, 4150U, 4159U}) {
    Hdl64eStatus status;
    Table table{};
    const int taken = feed(status, s3_laps(), start, true, table);
    EXPECT_EQ(table, Table::checked);
    EXPECT_GT(taken, 0);
    EXPECT_LE(taken, 4160 + 16) << start;
    expect_same(status.calibration(), s3().calibration);
  }
}

TEST(Hdl64eStatus, S2WithoutChecksumIsTaken) {
  Hdl64eStatus status;
  Table table{};
  EXPECT_GT(feed(status, s2_laps(), 5, false, table), 0);
  EXPECT_EQ(table, Table::unchecked);
  expect_same(status.calibration(), s2().calibration);
}

TEST(Hdl64eStatus, LostPacketsCostTheirOwnByteOnly) {
  std::mt19937 random(5);
  for (int run = 0; run < 5; ++run) {
    Hdl64eStatus status;
    std::uint32_t lost = 0;
    int taken = 0;
    Table table = Table::incomplete;
    for (std::size_t i = 0; i < s3_laps().size() && table == Table::incomplete; ++i, ++taken) {
      if (random() % 100 == 0) {
        ++lost;
        continue;
      }
      table = status.see(s3_laps()[i].type, s3_laps()[i].value, lost, true);
      lost = 0;
    }
    EXPECT_EQ(table, Table::checked);
    EXPECT_LE(taken, 3 * 4160);
    expect_same(status.calibration(), s3().calibration);
  }
}

TEST(Hdl64eStatus, ABurstOfLossIsFilledInTheNextLap) {
  Hdl64eStatus status;
  Table table = Table::incomplete;
  std::uint32_t lost = 0;
  std::size_t i = 0;
  for (; i < s3_laps().size() && table == Table::incomplete; ++i) {
    if (i >= 1000 && i < 1500) {
      ++lost;
      continue;
    }
    table = status.see(s3_laps()[i].type, s3_laps()[i].value, lost, true);
    lost = 0;
  }
  EXPECT_EQ(table, Table::checked);
  EXPECT_LE(i, 4160U + 1500U);
}

TEST(Hdl64eStatus, AMiscountIsNoticedByTheTypes) {
  Hdl64eStatus status;
  Table table{};
  for (std::size_t i = 0; i < 1000; ++i) status.see(s3_laps()[i].type, s3_laps()[i].value, 0, true);
  // Three packets are missing and nobody says so.
  const int taken = feed(status, s3_laps(), 1003, true, table);
  EXPECT_EQ(table, Table::checked);
  EXPECT_LE(taken, 4160 + 32);
  expect_same(status.calibration(), s3().calibration);
}

TEST(Hdl64eStatus, AWrongChecksumIsRefused) {
  HdlOptions options = s3();
  options.break_checksum = true;
  const auto laps = status_of(2 * 4160, options);
  Hdl64eStatus status;
  for (const Status& s : laps) EXPECT_NE(status.see(s.type, s.value, 0, true), Table::checked);
}

TEST(Hdl64eStatus, AWrongByteIsRefusedAndTheNextLapIsTaken) {
  auto laps = s3_laps();
  laps[16 * 41 + 12].value ^= 0x40;
  Hdl64eStatus status;
  int refused = 0;
  Table table{};
  for (const Status& s : laps) {
    table = status.see(s.type, s.value, 0, true);
    refused += table == Table::refused ? 1 : 0;
    if (table == Table::checked) break;
  }
  EXPECT_EQ(refused, 1);
  EXPECT_EQ(table, Table::checked);
  expect_same(status.calibration(), s3().calibration);
}

TEST(Hdl64eStatus, ValuesOutOfRangeAreRefused) {
  HdlOptions options = s2();
  options.calibration.lasers[17].vert_rad = 1.2;
  const auto laps = status_of(4160 + 16, options);
  Hdl64eStatus status;
  Table table{};
  feed(status, laps, 0, false, table);
  EXPECT_EQ(table, Table::refused);
}

TEST(Hdl64eStatus, NeitherLengthNorChecksumNeedsTwoEqualLaps) {
  HdlOptions options = s2();
  options.break_checksum = true;
  const auto laps = status_of(3 * 4160, options);
  Hdl64eStatus status;
  Table table{};
  const int taken = feed(status, laps, 0, false, table);
  EXPECT_EQ(table, Table::repeated);
  EXPECT_GT(taken, 4160);
  EXPECT_LE(taken, 2 * 4160 + 16);
}

// CRC-16 with polynomial 0x8005 from 0, not reflected ("CRC-16/UMTS"): its published check value.
TEST(Hdl64eStatus, ChecksumHasThePublishedCheckValue) {
  const std::array<std::uint8_t, 9> text = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(crc16(text.data(), text.size()), 0xFEE8);
}

TEST(Hdl64eTable, IsReadFromPacketsStoredAndThereAtTheNextStart) {
  const std::string folder = testing::TempDir() + "/lilo_state";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  SensorConfig config;
  config.state_directory = folder;
  const HdlOptions options{.drive = {.rpm = 1200, .start_azimuth_deg = 300},
                           .calibration = test::sample_calibration(true),
                           .without_returns = true};
  const auto packets = test::hdl64e_packets(4700, options);
  const test::Outcome first = test::build(packets, config);
  EXPECT_EQ(first.status.calibration, CalibrationOrigin::packets);
  EXPECT_GT(first.counts.waiting_packets, 4100U);
  EXPECT_GE(first.scans.size(), 1U);
  EXPECT_TRUE(std::filesystem::is_empty(folder)) << "no disk holds up who reads packets";
  ASSERT_TRUE(store_calibration(stored_calibration_path(folder), options.calibration));

  const std::vector<TimedPacket> start(packets.begin(), packets.begin() + 500);
  const test::Outcome second = test::build(start, config);
  EXPECT_EQ(second.status.calibration, CalibrationOrigin::stored);
  EXPECT_EQ(second.scans.size(), 2U);
  EXPECT_LT(second.counts.waiting_packets, 15U);
}

TEST(Hdl64eTable, ABrokenStoredOneIsAsGoodAsNone) {
  const std::string folder = testing::TempDir() + "/lilo_broken";
  std::filesystem::create_directories(folder);
  ASSERT_TRUE(
      store_calibration(folder + "/hdl64e_calibration.yaml", test::sample_calibration(true)));
  std::filesystem::resize_file(folder + "/hdl64e_calibration.yaml", 900);
  SensorConfig config;
  config.state_directory = folder;
  const HdlOptions options{.drive = {.rpm = 1200, .start_azimuth_deg = 300},
                           .calibration = test::sample_calibration(true),
                           .without_returns = true};
  EXPECT_EQ(test::build(test::hdl64e_packets(50, options), config).status.calibration,
            CalibrationOrigin::none);
}

TEST(Hdl64eTime, ComesFromTheStatusBytesWhenGpsIsThere) {
  const std::string file = testing::TempDir() + "/gps.yaml";
  ASSERT_TRUE(store_calibration(file, test::sample_calibration(true)));
  SensorConfig config;
  config.calibration_file = file;
  HdlOptions options{.drive = {.rpm = 1200, .start_azimuth_deg = 300},
                     .calibration = test::sample_calibration(true),
                     .without_returns = true};
  EXPECT_EQ(test::build(test::hdl64e_packets(500, options), config).scans[1].clock,
            ClockSource::gps);
  options.gps = false;
  EXPECT_EQ(test::build(test::hdl64e_packets(500, options), config).scans[1].clock,
            ClockSource::host);
}

}  // namespace
}  // namespace lilo
