// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/simulate.hpp"
#include "tools/sim/truth_writer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <sstream>
#include <string>
#include <unistd.h>
#include <vector>

namespace lilo::sim {
namespace {

std::string slurp(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::vector<double>> numbers(const std::filesystem::path& path) {
  std::vector<std::vector<double>> rows;
  std::istringstream text(slurp(path));
  for (std::string line; std::getline(text, line);) {
    std::istringstream fields(line);
    rows.emplace_back(std::istream_iterator<double>(fields), std::istream_iterator<double>());
  }
  return rows;
}

/// A folder of this process: ctest runs every test in one of its own, at the same time.
std::filesystem::path own_folder(const std::string& name) {
  return std::filesystem::path(testing::TempDir()) / (name + std::to_string(getpid()));
}

/// A short drive, made once for all tests of this file.
class Truth : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = own_folder("lilo_sim_truth_");
    simulate(options(), folder_.string(), [](double) {});
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(folder_); }
  static SimOptions options() {
    SimOptions options;
    options.world = "park";
    options.motion = {.speed_mps = 2.0, .duration_s = 1.5, .start_in_motion = true};
    return options;
  }
  static inline std::filesystem::path folder_;
};

TEST_F(Truth, SameOptionsGiveSameBytesAndAnotherSeedDoesNot) {
  const auto again = own_folder("lilo_sim_again_");
  simulate(options(), again.string(), [](double) {});
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    EXPECT_TRUE(slurp(entry.path()) == slurp(again / entry.path().filename())) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 8);
  SimOptions other = options();
  other.seed = 2;
  simulate(other, again.string(), [](double) {});
  EXPECT_FALSE(slurp(folder_ / "data.pcap") == slurp(again / "data.pcap"));
  std::filesystem::remove_all(again);
}

TEST_F(Truth, RevolutionsAreThoseOfThePackets) {
  // From the bytes: the stamp of the last block before each wrap and of the first one after it.
  const std::string pcap = slurp(folder_ / "data.pcap");
  std::vector<std::pair<double, double>> wraps;
  double last_azimuth = -1.0, last_time = 0.0;
  for (std::size_t at = 24; at + 16 < pcap.size();) {
    std::uint32_t length = 0;
    std::memcpy(&length, pcap.data() + at + 8, 4);
    const char* payload = pcap.data() + at + 16 + 42;
    at += 16 + length;
    if (length != 1248) continue;
    std::uint32_t stamp = 0;
    std::memcpy(&stamp, payload + 1200, 4);
    for (std::size_t block = 0; block < 12; ++block) {
      std::uint16_t raw = 0;
      std::memcpy(&raw, payload + 100 * block + 2, 2);
      const double time = stamp * 1e-6 + static_cast<double>(block) * 110.592e-6;
      if (raw < last_azimuth) wraps.emplace_back(last_time, time);
      last_azimuth = raw;
      last_time = time;
    }
  }
  const auto starts = numbers(folder_ / "gt_start.tum"), ends = numbers(folder_ / "gt_end.tum");
  ASSERT_EQ(starts.size() + 1, wraps.size());
  ASSERT_EQ(starts.size(), ends.size());
  for (std::size_t k = 0; k < starts.size(); ++k) {
    const double start = std::fmod(starts[k][0], 3600.0), end = std::fmod(ends[k][0], 3600.0);
    EXPECT_GT(start, wraps[k].first - 3e-6);
    EXPECT_LT(start, wraps[k].second + 3e-6);
    EXPECT_GT(end, wraps[k + 1].first - 3e-6);
    EXPECT_LT(end, wraps[k + 1].second + 3e-6);
  }
}

TEST_F(Truth, FormsAgreeWithEachOther) {
  const auto starts = numbers(folder_ / "gt_start.tum"), ends = numbers(folder_ / "gt_end.tum");
  const auto kitti = numbers(folder_ / "gt_end_kitti.txt"),
             dense = numbers(folder_ / "gt_dense.tum");
  ASSERT_EQ(kitti.size(), ends.size());
  ASSERT_EQ(dense.size(), 301U);
  EXPECT_EQ(starts[0], (std::vector<double>{starts[0][0], 0, 0, 0, 0, 0, 0, 1}));
  for (std::size_t k = 0; k < ends.size(); ++k) {
    if (k + 1 < starts.size()) {
      EXPECT_EQ(ends[k], starts[k + 1]);
    }
    const auto& e = ends[k];
    const double qx = e[4], qy = e[5], qz = e[6], qw = e[7];
    for (int row = 0; row < 3; ++row) {
      EXPECT_NEAR(kitti[k][static_cast<std::size_t>(4 * row + 3)],
                  e[static_cast<std::size_t>(row + 1)], 1e-6);
    }
    EXPECT_NEAR(kitti[k][0], 1 - 2 * (qy * qy + qz * qz), 1e-8);
    EXPECT_NEAR(kitti[k][4], 2 * (qx * qy + qz * qw), 1e-8);
    EXPECT_NEAR(kitti[k][8], 2 * (qx * qz - qy * qw), 1e-8);
    // Between two dense poses the motion is nearly uniform: 5 ms of 1 m/s^2 is 3 um from it.
    const double u = (e[0] - dense[0][0]) / 0.005;
    const auto i = static_cast<std::size_t>(u);
    for (std::size_t c = 1; c < 8; ++c) {
      const double s = u - static_cast<double>(i);
      EXPECT_NEAR(e[c], (1 - s) * dense[i][c] + s * dense[i + 1][c], 1e-4);
    }
  }
}

TEST(SensorPath, PositionAndHeadingHaveContinuousVelocity) {
  const Route route({{80.0, 0.0, 0.0}, {10.0, 0.0, 0.08}, {30.0, 0.08, 0.08}, {300.0, 0.0, 0.0}},
                    60.0);
  const Terrain terrain({-200, -200, 300, 300}, 0.5, [](double x, double y) -> Terrain::Sample {
    return {0.05 * std::sin(3.0 * x) * std::cos(2.0 * y), Material::soil};
  });
  const MotionOptions motion{.speed_mps = 8.0, .duration_s = 10.0};
  const Drive drive(motion, {}, route);
  const SensorPath path(motion, {}, route, drive, terrain);
  const double h = 1e-4;
  for (double t = 0.0; t < 10.0; t += 0.01) {  // every second one lies on a knot
    const auto before = path.at(t - h), at = path.at(t), after = path.at(t + h);
    const Vec3 jump = (after.translation_m - 2.0 * at.translation_m + before.translation_m) / h;
    EXPECT_LT(jump.norm(), 0.02);  // h times a bounded acceleration
    EXPECT_LT(((after.rotation - 2.0 * at.rotation + before.rotation) / h).norm(), 0.02);
  }
}

TEST(SensorPath, StandsStillUntilItSetsOffAndTurnsAsFastAsAsked) {
  const Route route({{200.0, 0.0, 0.0}}, 60.0);
  const Terrain terrain({-100, -100, 200, 100}, 0.5, [](double x, double y) -> Terrain::Sample {
    return {0.02 * x + 0.05 * std::sin(2.0 * y), Material::soil};
  });
  const MotionOptions motion{
      .speed_mps = 0.0, .duration_s = 6.0, .standstill_s = 2.0, .turn_rate_dps = 90.0};
  const Drive drive(motion, {}, route);
  const SensorPath path(motion, {.wander_m = 0.0}, route, drive, terrain);
  const Placement first = path.at(0.0), later = path.at(1.7);
  EXPECT_LT((first.translation_m - later.translation_m).norm(), 1e-9);
  EXPECT_LT((first.rotation - later.rotation).norm(), 1e-9);
  const Eigen::Matrix3d turn = path.at(4.0).rotation.transpose() * path.at(4.5).rotation;
  EXPECT_NEAR(std::acos(0.5 * (turn.trace() - 1.0)) * 180.0 / 3.14159265358979, 45.0, 0.5);
}

TEST(SensorPath, ASensorMayBeMountedUpsideDownAndNoseDown) {
  const Route route({{200.0, 0.0, 0.0}}, 60.0);
  const Terrain flat({-100, -100, 200, 100}, 0.5, [](double, double) -> Terrain::Sample {
    return {0.0, Material::soil};
  });
  const MotionOptions motion{.speed_mps = 0.0, .tilt_deg = 10.0, .roll_deg = 180.0};
  const SensorPath path(motion, {.wander_m = 0.0}, route, Drive(motion, {}, route), flat);
  const Eigen::Matrix3d R_world_sensor = path.at(0.0).rotation;
  const double tilt_rad = 10.0 * std::numbers::pi / 180.0;
  const Vec3 forward(std::cos(tilt_rad), 0.0, -std::sin(tilt_rad));
  const Vec3 up(-std::sin(tilt_rad), 0.0, -std::cos(tilt_rad));
  EXPECT_LT((R_world_sensor.col(0) - forward).norm(), 1e-6);
  EXPECT_LT((R_world_sensor.col(2) - up).norm(), 1e-6);
}

// At a constant rate after a ramp the turn is as if it had begun, at full rate, half way up it.
TEST(SensorPath, BeginsToTurnWithinTheRamp) {
  const Route route({{200.0, 0.0, 0.0}}, 60.0);
  const Terrain flat({-100, -100, 200, 100}, 0.5, [](double, double) -> Terrain::Sample {
    return {0.0, Material::soil};
  });
  for (const double ramp_s : {0.1, 1.0}) {
    const MotionOptions motion{.speed_mps = 0.0,
                               .duration_s = 6.0,
                               .standstill_s = 2.0,
                               .turn_rate_dps = 90.0,
                               .turn_ramp_s = ramp_s};
    const SensorPath path(motion, {.wander_m = 0.0}, route, Drive(motion, {}, route), flat);
    const Eigen::Matrix3d turn = path.at(1.9).rotation.transpose() * path.at(3.2).rotation;
    const double turned_deg = std::atan2(turn(1, 0), turn(0, 0)) * 180.0 / std::numbers::pi;
    EXPECT_NEAR(turned_deg, 90.0 * (1.2 - 0.5 * ramp_s), 0.05);
  }
}

TEST(SensorPath, ShakesAsAskedWhileItDrives) {
  const Route route({{300.0, 0.0, 0.0}}, 60.0);
  const Terrain terrain({-100, -100, 300, 100}, 0.5, [](double, double) -> Terrain::Sample {
    return {0.0, Material::soil};
  });
  const MotionOptions motion{.duration_s = 20.0, .shake_hz = 12.0, .shake_dps = 2.0};
  const Drive drive(motion, {}, route);
  const SensorPath path(motion, {.wander_m = 0.0}, route, drive, terrain);
  const double h = 1e-3;
  const auto rate_radps = [&](double t_s) -> Vec3 {
    const Eigen::Matrix3d turn = path.at(t_s - h).rotation.transpose() * path.at(t_s + h).rotation;
    return Vec3(turn(2, 1), turn(0, 2), turn(1, 0)) / (2.0 * h);
  };
  EXPECT_LT(rate_radps(0.3).norm(), 1e-6);
  Vec3 squares = Vec3::Zero();
  constexpr int kSteps = 5000;
  // From where it neither speeds up nor brakes.
  for (int k = 0; k < kSteps; ++k) squares += rate_radps(10.0 + 1e-3 * k).cwiseAbs2() / kSteps;
  const Vec3 rms_dps = squares.cwiseSqrt() * 180.0 / std::numbers::pi;
  EXPECT_NEAR(rms_dps.x(), 2.0, 0.1);
  EXPECT_NEAR(rms_dps.y(), 2.0, 0.1);
  EXPECT_LT(rms_dps.z(), 0.1);
}

}  // namespace
}  // namespace lilo::sim
