// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/packet_source.hpp"
#include "drivers/scan_source.hpp"
#include "tests/drivers/data_dir.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

/// Raw drives of KITTI: points as measured, by a beam that turns clockwise from straight behind.
namespace lilo {
namespace {

namespace fs = std::filesystem;
constexpr float kDeg = std::numbers::pi_v<float> / 180.0F;
/// 2011-09-26 13:02:25 UTC, says `date -u -d ... +%s`.
constexpr std::int64_t kSecond_ns = 1'317'042'145'000'000'000;

/// A drive with two scans, number 0 and 2; of number 1 there are only the empty lines.
class RawDrive : public testing::Test {
 protected:
  RawDrive() {
    fs::remove_all(drive_);
    fs::create_directories(points_ + "/data");
    // Two rings as stored: counter-clockwise from straight ahead, the upper one first.
    for (const float z_m : {1.0F, -1.0F}) {
      for (const float azimuth_deg : {1.0F, 89.0F, 179.0F, 181.0F, 271.0F, 359.0F}) {
        const float a = azimuth_deg * kDeg;
        for (const float v : {10.0F * std::cos(a), 10.0F * std::sin(a), z_m, 0.5F})
          stored_.push_back(v);
      }
    }
    for (const char* name : {"0000000000.bin", "0000000002.bin"}) {
      std::ofstream out(points_ + "/data/" + name, std::ios::binary);
      out.write(reinterpret_cast<const char*>(stored_.data()),
                static_cast<std::streamsize>(stored_.size() * sizeof(float)));
    }
  }
  void write(const char* name, const std::string& text) const {
    std::ofstream(points_ + "/" + name) << text;
  }
  void write_begin_and_end() const {
    write("timestamps_start.txt", "2011-09-26 13:02:25.5\n\n2011-09-26 13:02:26.700000000\n");
    write("timestamps_end.txt", "2011-09-26 13:02:25.608\n\n2011-09-26 13:02:26.800000001\n");
  }
  [[nodiscard]] std::string refusal() const {
    try {
      open_scans(drive_, {});
    } catch (const DriverError& e) {
      return e.what();
    }
    return "opened";
  }

  // Tests run side by side: each has a folder of its own.
  std::string drive_ = testing::TempDir() + '/' +
                       testing::UnitTest::GetInstance()->current_test_info()->name() +
                       "/2011_09_26_drive_0001_sync";
  std::string points_ = drive_ + "/velodyne_points";
  std::vector<float> stored_;
};

TEST_F(RawDrive, SweepsLastFromBeginToEndAndAreNotCompensated) {
  write_begin_and_end();
  for (const std::string& path : {drive_, points_ + "/data"}) {
    const auto source = open_scans(path, {});
    Scan scan;
    ASSERT_TRUE(source->next(scan));
    EXPECT_FALSE(scan.motion_compensated);
    EXPECT_EQ(scan.clock, ClockSource::replay);
    EXPECT_EQ(scan.start_ns, kSecond_ns + 500'000'000);
    EXPECT_EQ(scan.end_ns, kSecond_ns + 608'000'000);
    ASSERT_TRUE(source->next(scan));
    EXPECT_EQ(scan.index, 2U);
    EXPECT_EQ(scan.start_ns, kSecond_ns + 1'700'000'000);
    EXPECT_EQ(scan.end_ns, kSecond_ns + 1'800'000'001);
  }
}

/// A turn of 108 ms takes 0.3 ms a degree: to 179 degrees, left of straight behind, 1 degree of
/// turning or 0.3 ms; to 89, on the left, 27.3 ms; on by the front and the right to -179.
TEST_F(RawDrive, ReturnsAreTimedClockwiseFromStraightBehindAndSorted) {
  write_begin_and_end();
  const auto source = open_scans(drive_, {});
  Scan scan;
  ASSERT_TRUE(source->next(scan));
  constexpr std::array<float, 6> kAzimuth_deg = {179, 89, 1, -1, -89, -179};
  constexpr std::array<double, 6> kAfter_ms = {0.3, 27.3, 53.7, 54.3, 80.7, 107.7};
  ASSERT_EQ(scan.returns.size(), 12U);
  for (std::size_t k = 0; k < 12; ++k) {
    const Return& r = scan.returns[k];
    EXPECT_NEAR(static_cast<double>(r.t_ns) * 1e-6, kAfter_ms[k / 2], 1e-4) << k;
    EXPECT_NEAR(r.azimuth_rad, kAzimuth_deg[k / 2] * kDeg, 1e-5F) << k;
    EXPECT_NEAR(std::atan2(r.y_m, r.x_m), r.azimuth_rad, 1e-6F) << k;
  }
}

TEST_F(RawDrive, WithoutBeginAndEndATurnLiesAroundTheInstantItLookedAhead) {
  write("timestamps.txt", "2011-09-26 13:02:25.25\n\n2011-09-26 13:02:25.45\n");
  const auto source = open_scans(drive_, {});
  Scan scan;
  ASSERT_TRUE(source->next(scan));
  EXPECT_FALSE(scan.motion_compensated);
  EXPECT_EQ(scan.start_ns, kSecond_ns + 200'000'000);
  EXPECT_EQ(scan.end_ns, kSecond_ns + 300'000'000);
  ASSERT_TRUE(source->next(scan));
  EXPECT_EQ(scan.end_ns, kSecond_ns + 500'000'000);
}

TEST_F(RawDrive, WithoutTimesTurnsAreATenthOfASecondApart) {
  const auto source = open_scans(drive_, {});
  Scan scan;
  ASSERT_TRUE(source->next(scan));
  const std::int64_t first_ns = scan.start_ns;
  EXPECT_EQ(scan.end_ns - first_ns, 100'000'000);
  ASSERT_TRUE(source->next(scan));
  EXPECT_EQ(scan.start_ns - first_ns, 200'000'000);
}

TEST_F(RawDrive, BadTimesAreOneClearLine) {
  write("timestamps.txt", "2011-13-26 13:02:25.5\n");
  EXPECT_EQ(refusal(), points_ +
                           "/timestamps.txt:1: expected a time in seconds, or date and time, "
                           "found \"2011-13-26 13:02:25.5\"");
  write("timestamps.txt", "2011-09-26 13:02:25.5\n\n\n");
  EXPECT_EQ(refusal(), points_ + "/timestamps.txt:3: expected the time of scan 2, found none");
  write("timestamps_end.txt", "1.2\n\n1.4\n");
  EXPECT_EQ(refusal(), points_ +
                           "/timestamps_start.txt: expected it beside timestamps_end.txt, found "
                           "no such file");
  write("timestamps_start.txt", "1.1\n\n1.5\n");
  EXPECT_EQ(refusal(), points_ +
                           "/timestamps_end.txt:3: expected up to 1 s after timestamps_start.txt, "
                           "found -0.100000 s");
}

/// KITTI's own drive: its files say that a turn takes 103.4 ms and that the next one begins where
/// it ends.
TEST(RealRawDrive, TimesRiseFromTheBeginOfEveryTurnToItsEnd) {
  const std::string drive = "real/kitti_raw_0009/2011_09_26/2011_09_26_drive_0009_sync";
  LILO_NEED_DATA(drive);
  const auto source = open_scans(test::data_path(drive), {});
  Scan scan;
  std::size_t count = 0;
  for (std::int64_t last_end_ns = 0; source->next(scan); ++count, last_end_ns = scan.end_ns) {
    EXPECT_FALSE(scan.motion_compensated);
    EXPECT_EQ(scan.beams.ring_count, 64);
    EXPECT_NEAR(static_cast<double>(scan.end_ns - scan.start_ns), 103.4e6, 0.2e6);
    if (count > 0) {
      EXPECT_NEAR(static_cast<double>(scan.start_ns - last_end_ns), 0.0, 1e4);
    }
    ASSERT_GT(scan.returns.size(), 100'000U);
    EXPECT_TRUE(std::is_sorted(scan.returns.begin(), scan.returns.end(),
                               [](const Return& a, const Return& b) { return a.t_ns < b.t_ns; }));
    const auto span_ns = static_cast<std::int32_t>(scan.end_ns - scan.start_ns);
    EXPECT_GE(scan.returns.front().t_ns, 0);
    EXPECT_LT(scan.returns.front().t_ns, span_ns / 100);
    EXPECT_GT(scan.returns.back().t_ns, span_ns / 100 * 99);
    EXPECT_LE(scan.returns.back().t_ns, span_ns);
  }
  EXPECT_EQ(count, 20U);
}

}  // namespace
}  // namespace lilo
