// SPDX-License-Identifier: BSD-3-Clause
// A scan's features are the same bits, whole or in parts, wherever the parts are divided.
#include "core/feature_extractor.hpp"

#include "core/level_frame.hpp"
#include "core/odometry.hpp"
#include "tests/core/analytic_scene.hpp"
#include "tests/core/mounts.hpp"
#include "tests/core/profiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace lilo {
namespace {

using test::kNoseDown, test::kUpright, test::kUpsideDown;

/// Of a sensor like the HDL-64E: the beams of one firing look up to 18 degrees apart.
Scan fanned_scan(double start_azimuth_rad, bool counter_clockwise = false, int firings = 1200,
                 const Eigen::Quaterniond& R_body_sensor = kUpright) {
  const auto drive = [&](double s) {
    return Pose{so3_exp({0, 0, 0.05 * s}) * R_body_sensor, {s, 0, 0}};
  };
  const BeamTable beams = test::even_beams(64, -24.8, 2.0);
  Scan scan = test::scan_of(test::yard(), in_level_axes(beams, R_body_sensor), firings, drive);
  const float sense = counter_clockwise ? -1.0F : 1.0F;
  for (Return& r : scan.returns) {
    const float fan_rad = 0.157F * static_cast<float>(r.ring % 9 - 4) / 4.0F;
    const auto turn_rad = static_cast<float>(start_azimuth_rad) + fan_rad;
    const float azimuth_rad = sense * std::atan2(r.y_m, r.x_m) + turn_rad;
    const float flat_m = std::hypot(r.x_m, r.y_m);
    r.x_m = flat_m * std::cos(azimuth_rad);
    r.y_m = flat_m * std::sin(azimuth_rad);
    r.azimuth_rad = std::atan2(r.y_m, r.x_m);
  }
  return scan;
}

auto values_of(const Feature& f) {
  return std::tuple(f.x_m, f.y_m, f.z_m, f.s, f.dx_m, f.dy_m, f.dz_m, f.kind, f.ring, f.column);
}

void expect_same(const ScanFeatures& a, const ScanFeatures& b, const std::string& what) {
  EXPECT_EQ(a.R_level_sensor.coeffs(), b.R_level_sensor.coeffs()) << what;
  ASSERT_EQ(a.all.size(), b.all.size()) << what;
  const auto [at, other] =
      std::mismatch(a.all.begin(), a.all.end(), b.all.begin(),
                    [](const auto& f, const auto& g) { return values_of(f) == values_of(g); });
  EXPECT_EQ(at - a.all.begin(), std::ssize(a.all)) << what << ": the first feature that differs";
}

ScanFeatures of_whole(const Scan& scan) {
  FeatureExtractor extractor{OdometryConfig{}};
  ScanFeatures features;
  extractor.finish(scan, features);
  return features;
}

/// The scan as it was when it had so many returns.
Scan beginning_of(const Scan& scan, std::size_t count) {
  Scan part = scan;
  part.returns.resize(count);
  part.end_ns = 0;  // not yet known
  return part;
}

std::vector<std::size_t> random_borders(std::size_t count, std::mt19937& random) {
  std::vector<std::size_t> borders(1 + random() % 40);
  for (std::size_t& b : borders) b = random() % (count + 1);
  std::sort(borders.begin(), borders.end());
  return borders;
}

class InParts : public testing::Test {
 protected:
  /// One extractor for all, as in the daemon: a scan leaves behind how the sensor is tilted, and
  /// what the robot itself is.
  void expect_same_in_parts(const Scan& scan, const std::string& what) {
    for (int round = 0; round < 4; ++round) {
      ScanFeatures whole;
      whole_.finish(scan, whole);
      EXPECT_GT(whole.all.size(), 15'000U);
      for (const std::size_t border : random_borders(scan.returns.size(), random_))
        extractor_.follow(beginning_of(scan, border));
      ScanFeatures features;
      extractor_.finish(scan, features);
      expect_same(features, whole, what);
    }
  }

  std::mt19937 random_{7};
  FeatureExtractor whole_{OdometryConfig{}}, extractor_{OdometryConfig{}};
};

TEST_F(InParts, WhereverTheTurnBegins) {
  for (const double start_rad : {0.0, 1.0, -1.5, 3.1})
    expect_same_in_parts(fanned_scan(start_rad), std::to_string(start_rad));
}

TEST_F(InParts, WhicheverWayTheSensorTurns) {
  expect_same_in_parts(fanned_scan(0.3, true), "counter-clockwise");
}

// Then columns lack rings, and those beside them stand in.
TEST_F(InParts, WhereTheSensorTurnsFast) {
  for (const double start_rad : {0.0, 2.0})
    expect_same_in_parts(fanned_scan(start_rad, false, 400), std::to_string(start_rad));
}

// Its first scan is looked at twice, the others are levelled as they come.
TEST_F(InParts, WhereTheSensorIsTilted) {
  const Scan scan = fanned_scan(0.0, false, 1200, kNoseDown);
  EXPECT_NE(of_whole(scan).R_level_sensor.w(), 1.0);
  expect_same_in_parts(scan, "tilted");
}

TEST_F(InParts, WhereTheSensorIsUpsideDown) {
  const Scan scan = fanned_scan(0.0, false, 1200, kUpsideDown);
  EXPECT_TRUE(is_upside_down(of_whole(scan).R_level_sensor));
  expect_same_in_parts(scan, "upside down");
}

TEST_F(InParts, WithHalfOfTheViewBlocked) {
  Scan scan = fanned_scan(0.0);
  std::erase_if(scan.returns, [](const Return& r) { return r.y_m < 0.0F && r.x_m > -5.0F; });
  expect_same_in_parts(scan, "blocked");
}

// A quarter of the rays meet a drop, unless something is nearer: 30 % of what is near is isolated.
TEST_F(InParts, WithDrops) {
  for (const double start_rad : {0.0, 2.0}) {
    Scan scan = fanned_scan(start_rad);
    for (Return& r : scan.returns) {
      const float range_m = 2.0F + static_cast<float>(random_() % 1000U) / 100.0F;
      const float stretch = range_m / std::hypot(r.x_m, r.y_m, r.z_m);
      if (random_() % 4 != 0 || stretch >= 1.0F) continue;
      r.x_m *= stretch;
      r.y_m *= stretch;
      r.z_m *= stretch;
    }
    expect_same_in_parts(scan, std::to_string(start_rad));
    EXPECT_LT(of_whole(scan).all.size(), 32'000U) << "34 755 with the drops";
  }
}

// A data set's scan, and a return of a wrong azimuth: no column can be done with before the end.
TEST_F(InParts, WhateverTheOrder) {
  Scan by_ring = fanned_scan(0.0);
  std::stable_sort(by_ring.returns.begin(), by_ring.returns.end(),
                   [](const Return& a, const Return& b) { return a.ring < b.ring; });
  expect_same_in_parts(by_ring, "ring by ring");
  Scan stray = fanned_scan(0.0);
  std::swap(stray.returns[1000], stray.returns[60'000]);
  std::swap(stray.returns[5'000], stray.returns[70'000]);
  expect_same_in_parts(stray, "stray");
}

// A packet is overtaken by a few or by many others, and put in its place when it comes.
TEST_F(InParts, WithPacketsThatWereOvertaken) {
  const Scan scan = fanned_scan(0.0);
  const ScanFeatures whole = of_whole(scan);
  for (const std::size_t overtaken_by : {400UL, 1'200UL, 5'000UL, 30'000UL}) {
    const auto at = static_cast<std::ptrdiff_t>(random_() % 40'000);
    Scan late = scan;
    late.returns.erase(late.returns.begin() + at, late.returns.begin() + at + 384);
    const auto came = static_cast<std::size_t>(at) + overtaken_by;
    for (std::size_t n = 0; n < came; n += 384) extractor_.follow(beginning_of(late, n));
    extractor_.follow(beginning_of(late, came));
    extractor_.inserted(static_cast<std::size_t>(at));
    for (std::size_t n = came + 384; n < scan.returns.size(); n += 384)
      extractor_.follow(beginning_of(scan, n));
    ScanFeatures features;
    extractor_.finish(scan, features);
    expect_same(features, whole, "overtaken by " + std::to_string(overtaken_by));
  }
}

/// Features of a sensor in the yard, by ring and firing; `firings` of them, counter-clockwise from
/// ahead. Upright its rings are closer together below.
std::vector<Feature> by_ray_in_the_yard(const Eigen::Quaterniond& R_world_sensor, int firings) {
  constexpr int kRings = 16;
  constexpr float kTurn_rad = 2.0F * std::numbers::pi_v<float>;
  BeamTable beams = test::even_beams(kRings, -16.0, 16.0);
  for (float& rad : std::span(beams.elevation_rad).first(kRings)) rad += 0.7F * rad * rad - 0.06F;
  const ScanFeatures found = of_whole(
      test::scan_of(test::yard(), in_level_axes(beams, R_world_sensor), firings, [&](double) {
        return Pose{R_world_sensor, {0.0, 0.0, 0.0}};
      }));
  std::vector<Feature> by_ray(static_cast<std::size_t>(kRings * firings));
  for (const Feature& f : found.all) {
    const float turns = std::atan2(f.y_m, f.x_m) / kTurn_rad + 1.0F;
    const auto firing = std::lround(turns * static_cast<float>(firings)) % firings;
    by_ray[static_cast<std::size_t>(int{f.ring} * std::ptrdiff_t{firings} + firing)] = f;
  }
  return by_ray;
}

// Its rays are the same, and so are the features in level axes.
TEST(FeatureExtractor, AnUpsideDownSensorSeesWhatAnUprightOneSees) {
  constexpr int kFirings = 512;  // each in a column of its own
  const auto upright = by_ray_in_the_yard(kUpright, kFirings);
  const auto upside_down = by_ray_in_the_yard(kUpsideDown, kFirings);
  const auto is_found = [](const Feature& f) { return f.x_m != 0.0F; };
  EXPECT_GT(std::count_if(upright.begin(), upright.end(), is_found), 5000);
  for (std::size_t ray = 0; ray < upright.size(); ++ray) {
    const Feature &f = upright[ray], &g = upside_down[ray];
    ASSERT_EQ(f.kind, g.kind) << "ring " << ray / kFirings << ", firing " << ray % kFirings;
    EXPECT_LT((Eigen::Vector3f(f.x_m, f.y_m, f.z_m) - Eigen::Vector3f(g.x_m, g.y_m, g.z_m)).norm(),
              1e-3F);
    EXPECT_LT(
        (Eigen::Vector3f(f.dx_m, f.dy_m, f.dz_m) - Eigen::Vector3f(g.dx_m, g.dy_m, g.dz_m)).norm(),
        1e-3F);
  }
}

TEST(FeatureExtractor, OnlyTheFirstScanTellsTheTilt) {
  FeatureExtractor extractor{OdometryConfig{}};
  ScanFeatures features;
  extractor.finish(fanned_scan(0.0), features);
  extractor.finish(fanned_scan(0.0, false, 1200, kNoseDown), features);
  EXPECT_EQ(features.R_level_sensor.w(), 1.0);
}

// The daemon's way and that of the tools.
TEST(FeatureExtractor, MakesTheSameTrajectoryInParts) {
  for (const Profile profile : test::profiles()) {
    OdometryConfig config;
    config.profile = profile;
    Odometry whole(config), in_parts(config);
    FeatureExtractor extractor(config);
    ScanFeatures features;
    std::mt19937 random(3);
    for (std::uint64_t k = 0; k < 8; ++k) {
      const auto at = [&](double s) {
        const double x_m = 0.5 * (static_cast<double>(k) + s);
        return Pose{so3_exp({0.0, 0.0, 0.02 * x_m}), {x_m - 5.0, 0.0, 0.0}};
      };
      const Scan scan = test::scan_of(test::yard(), test::even_beams(16, -15.0, 15.0), 900, at, k);
      const Estimate expected = whole.process(scan);
      for (const std::size_t border : random_borders(scan.returns.size(), random))
        extractor.follow(beginning_of(scan, border));
      extractor.finish(scan, features);
      const Estimate found = in_parts.align(scan, features);
      in_parts.update_map(features);
      EXPECT_EQ(found.T_odom_sensor.translation_m, expected.T_odom_sensor.translation_m);
      EXPECT_EQ(found.T_odom_sensor.rotation.coeffs(), expected.T_odom_sensor.rotation.coeffs());
      EXPECT_EQ(found.status, expected.status);
    }
  }
}

}  // namespace
}  // namespace lilo
