// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/kitti_rings.hpp"
#include "drivers/packet_source.hpp"
#include "drivers/scan_source.hpp"
#include "tests/drivers/capture_file.hpp"
#include "tests/drivers/data_dir.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

namespace lilo {
namespace {

namespace fs = std::filesystem;
constexpr double kDeg = std::numbers::pi / 180.0;

std::string fresh_folder(const std::string& name) {
  std::string path = testing::TempDir() + "/" + name;
  fs::remove_all(path);
  fs::create_directories(path);
  return path;
}

std::string refusal(const std::string& path) {
  try {
    open_scans(path, {});
  } catch (const DriverError& e) {
    return e.what();
  }
  return "opened";
}

// 64 rings from +2 to -24.8 degrees, highest first, each counter-clockwise from straight ahead,
// with holes and with the encoder's noise at the start.
Returns rings_as_stored(std::vector<int>& truth) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.02 * kDeg);
  Returns returns;
  truth.clear();
  for (int stored = 0; stored < 64; ++stored) {
    const double w = (2.0 - 26.8 * stored / 63.0) * kDeg;
    for (int i = 0; i < 2000; ++i) {
      if (i > 300 && i < 500 && stored % 3 == 0) continue;
      double a = std::remainder((i + 0.5) * 0.18 * kDeg + noise(random), 2 * std::numbers::pi);
      const double r = 10.0 + 3.0 * std::sin(5 * a);
      returns.push_back({.x_m = static_cast<float>(r * std::cos(w) * std::cos(a)),
                         .y_m = static_cast<float>(r * std::cos(w) * std::sin(a)),
                         .z_m = static_cast<float>(r * std::sin(w)),
                         .azimuth_rad = static_cast<float>(a)});
      truth.push_back(63 - stored);
    }
  }
  return returns;
}

TEST(KittiRings, AreToldByTheOrderOfStorage) {
  std::vector<int> truth;
  auto returns = rings_as_stored(truth);
  BeamTable beams;
  recover_kitti_rings(returns, beams);
  ASSERT_EQ(beams.ring_count, 64);
  for (std::size_t i = 0; i < returns.size(); ++i) ASSERT_EQ(returns[i].ring, truth[i]) << i;
  EXPECT_NEAR(static_cast<double>(beams.elevation_rad[0]), -24.8 * kDeg, 1e-4);
  EXPECT_NEAR(static_cast<double>(beams.elevation_rad[63]), 2.0 * kDeg, 1e-4);
}

TEST(KittiRings, AreBinsOfElevationWhenTheOrderIsLost) {
  std::vector<int> truth;
  auto returns = rings_as_stored(truth);
  std::mt19937 random(2);
  std::shuffle(returns.begin(), returns.end(), random);
  BeamTable beams;
  recover_kitti_rings(returns, beams);
  ASSERT_EQ(beams.ring_count, 64);
  for (const Return& r : returns) {
    const double w = std::atan2(static_cast<double>(r.z_m),
                                std::hypot(static_cast<double>(r.x_m), static_cast<double>(r.y_m)));
    ASSERT_NEAR(w, static_cast<double>(beams.elevation_rad[r.ring]), 0.3 * kDeg);
  }
}

TEST(KittiScans, RealOnesHaveSixtyFourRings) {
  LILO_NEED_DATA("real/kitti_00");
  auto source = open_scans(test::data_path("real/kitti_00"), {});
  Scan scan;
  std::size_t count = 0;
  for (; source->next(scan); ++count) {
    EXPECT_EQ(scan.index, count);
    EXPECT_TRUE(scan.complete);
    EXPECT_TRUE(scan.motion_compensated);
    EXPECT_EQ(scan.clock, ClockSource::replay);
    ASSERT_EQ(scan.beams.ring_count, 64);
    EXPECT_GT(scan.returns.size(), 120'000U);
    EXPECT_TRUE(
        std::is_sorted(scan.beams.elevation_rad.begin(), scan.beams.elevation_rad.begin() + 64));
    // HDL-64E S2: -24.9 to +2 degrees as seen from each laser's own origin.
    EXPECT_NEAR(static_cast<double>(scan.beams.elevation_rad[0]), -24.0 * kDeg, 1.5 * kDeg);
    EXPECT_NEAR(static_cast<double>(scan.beams.elevation_rad[63]), 2.5 * kDeg, 1.0 * kDeg);
  }
  EXPECT_EQ(count, 16U);
  EXPECT_EQ(source->progress(), 1.0);
  EXPECT_EQ(source->error(), "");
}

TEST(KittiScans, TimesAreThoseOfTimesTxt) {
  LILO_NEED_DATA("real/kitti_00");
  std::ifstream in(test::data_path("real/kitti_00/times.txt"));
  auto source = open_scans(test::data_path("real/kitti_00"), {});
  Scan scan;
  double seconds = 0.0;
  while (source->next(scan) && in >> seconds)
    EXPECT_NEAR(static_cast<double>(scan.end_ns), seconds * 1e9, 1.0);
}

TEST(KittiScans, ABareFolderGivesStepsOfATenthOfASecond) {
  const std::string folder = fresh_folder("bare");
  const std::array<float, 8> points = {5, 0, 0, 0.5F, 0, 5, 1, 1.0F};
  for (const char* name : {"000003.bin", "000004.bin", "000006.bin", "notes.txt"}) {
    std::ofstream out(folder + "/" + name, std::ios::binary);
    out.write(reinterpret_cast<const char*>(points.data()), sizeof(points));
  }
  auto source = open_scans(folder, {});
  Scan scan;
  std::vector<std::int64_t> times;
  std::vector<std::uint64_t> indices;
  while (source->next(scan)) {
    times.push_back(scan.end_ns);
    indices.push_back(scan.index);
    ASSERT_EQ(scan.returns.size(), 2U);
    EXPECT_EQ(scan.returns[0].intensity, 128);
    EXPECT_EQ(scan.returns[1].intensity, 255);
  }
  EXPECT_EQ(times, (std::vector<std::int64_t>{0, 100'000'000, 300'000'000}));
  EXPECT_EQ(indices, (std::vector<std::uint64_t>{0, 1, 3}));
}

void write_points(const std::string& file, const std::vector<float>& numbers) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(numbers.data()),
            static_cast<std::streamsize>(numbers.size() * sizeof(float)));
}

TEST(KittiScans, TheElevationOffsetRaisesEveryRayAndKeepsRangeAndAzimuth) {
  const std::string folder = fresh_folder("raised");
  write_points(folder + "/000000.bin", {10, 0, 0, 0, -3, 4, -2, 0, 1, -1, 30, 0, 0, 0, 7, 0});
  auto plain = open_scans(folder, {});
  auto raised = open_scans(folder, {.kitti_elevation_offset_rad = 0.205 * kDeg});
  Scan before, after;
  ASSERT_TRUE(plain->next(before));
  ASSERT_TRUE(raised->next(after));
  ASSERT_EQ(after.returns.size(), 4U);
  const auto elevation = [](const Return& r) {
    return std::atan2(static_cast<double>(r.z_m), static_cast<double>(std::hypot(r.x_m, r.y_m)));
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const Return &a = before.returns[k], &b = after.returns[k];
    EXPECT_NEAR(elevation(b) - elevation(a), 0.205 * kDeg, 1e-6);
    EXPECT_NEAR(std::hypot(a.x_m, a.y_m, a.z_m), std::hypot(b.x_m, b.y_m, b.z_m), 1e-5F);
    EXPECT_NEAR(std::atan2(a.y_m, a.x_m), std::atan2(b.y_m, b.x_m), 1e-6F);
  }
  EXPECT_EQ(after.returns[3].z_m, 7.0F);  // straight up has no vertical plane of its own
}

TEST(KittiScans, BadInputIsOneClearLine) {
  const std::string folder = fresh_folder("nothing");
  EXPECT_EQ(refusal(folder), folder + ": expected scans named NNNNNN.bin, found none");
  fs::create_directories(folder + "/velodyne");
  EXPECT_NE(refusal(folder).find("found none"), std::string::npos);
  std::ofstream(folder + "/velodyne/000000.bin") << "0123456789abcdef0";
  std::ofstream(folder + "/times.txt") << "0.0\nsoon\n";
  EXPECT_EQ(refusal(folder),
            folder +
                "/times.txt:2: expected a time in seconds, or date and time, found "
                "\"soon\"");
  fs::remove(folder + "/times.txt");
  auto source = open_scans(folder, {});
  Scan scan;
  ASSERT_TRUE(source->next(scan));
  EXPECT_FALSE(scan.complete);
  EXPECT_NE(source->error().find("17 bytes"), std::string::npos);
}

}  // namespace
}  // namespace lilo
