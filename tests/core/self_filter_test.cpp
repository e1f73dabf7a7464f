// SPDX-License-Identifier: BSD-3-Clause
// The robot itself is no structure, and everything else stays.
#include "core/image/self_filter.hpp"

#include "core/feature_extractor.hpp"
#include "core/odometry.hpp"
#include "tests/core/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace lilo::core {
namespace {

const BeamTable kBeams = test::even_beams(16, -15.0, 15.0);
constexpr int kScans = 30;

using Drive = std::function<Pose(double t_s)>;
const Drive kForward = [](double t_s) { return Pose{so3_exp({}), {5.0 * t_s, 0.0, 0.0}}; };
const Drive kAtRest = [](double) { return Pose{}; };

/// A tenth of a second of the drive.
Scan scan_at(const test::Scene& scene, const Drive& drive, int index) {
  return test::scan_of(
      scene, kBeams, 1800, [&](double s) { return drive(0.1 * (index + s)); },
      static_cast<std::uint64_t>(index));
}

/// A mast behind the sensor, with so much room between.
test::Scene mast(double gap_m) {
  test::Scene robot;
  robot.poles.push_back({-gap_m - 0.4, 0.0, 0.4, 5.0});
  return robot;
}

/// What a sensor sees of the world and of the robot, which is nearer.
Scan with_robot(Scan scan, const Scan& robot) {
  const auto key = [](const Return& r) { return std::pair(r.t_ns, r.ring); };
  std::map<std::pair<std::int32_t, std::uint8_t>, Return> returns;
  for (const Scan* part : {&std::as_const(scan), &robot}) {
    for (const Return& r : part->returns) returns[key(r)] = r;
  }
  scan.returns.clear();
  for (const auto& [at, r] : returns) scan.returns.push_back(r);
  return scan;
}

bool is_mast(const Feature& f) { return f.x_m < 0.0F && std::hypot(f.x_m, f.y_m) < 2.0F; }

/// Features of some kind in the last of several scans, and how many of them are left.
struct Count {
  std::ptrdiff_t all = 0, left = 0;
};
class Filtered {
 public:
  Count add(const Scan& scan, const std::function<bool(const Feature&)>& counts,
            Count* others = nullptr) {
    std::vector<Feature>& features = image_.build(scan);
    const auto count = [&] { return std::count_if(features.begin(), features.end(), counts); };
    const std::ptrdiff_t all = std::ssize(features);
    Count found{count()};
    filter_.filter(features, image_.too_near(), image_.size());
    found.left = count();
    if (others != nullptr) *others = {all - found.all, std::ssize(features) - found.left};
    return found;
  }

 private:
  FeatureImage image_{1024, {1.0, 100.0}};
  SelfFilter filter_;
};

Count after_scans(const std::function<Scan(int)>& scan,
                  const std::function<bool(const Feature&)>& counts) {
  Filtered filtered;
  Count last;
  for (int k = 0; k < kScans; ++k) last = filtered.add(scan(k), counts);
  return last;
}

/// A drive along a road with a mast in view, with the range noise of an HDL-64E.
Count after_noisy_scans(const test::Scene& mast, const Drive& drive) {
  std::mt19937 rng(1);
  const Scan robot = scan_at(mast, kAtRest, 0);
  return after_scans(
      [&](int k) {
        Scan scan = with_robot(scan_at(test::road_with_posts(), drive, k), robot);
        test::add_range_noise(scan, 0.02F, rng);
        return scan;
      },
      is_mast);
}

TEST(SelfFilter, LeavesOutAMastAndNothingElse) {
  const Scan robot = scan_at(mast(1.2), kAtRest, 0);
  Filtered filtered;
  for (int k = 0; k < kScans; ++k) {
    const Scan scan = with_robot(scan_at(test::road_with_posts(), kForward, k), robot);
    Count of_others;
    const Count of_mast = filtered.add(scan, is_mast, &of_others);
    EXPECT_GT(of_mast.all, 500);
    EXPECT_EQ(of_mast.left, k < 2 ? of_mast.all : 0) << "scan " << k;
    EXPECT_EQ(of_others.left, of_others.all) << "scan " << k;
  }
}

// Its front is nearer than what is used for odometry, and noise decides which returns count.
TEST(SelfFilter, LeavesOutWhatGoesOnFromBelowTheLeastRange) {
  const Count of_mast = after_noisy_scans(mast(0.85), kForward);
  EXPECT_GT(of_mast.all, 20);
  EXPECT_EQ(of_mast.left, 0);
}

TEST(SelfFilter, LeavesOutARobotInRain) {
  std::mt19937 rng(2);
  std::uniform_real_distribution<float> part(0.0F, 1.0F);
  const Count of_mast = after_scans(
      [&](int k) {
        Scan robot = scan_at(mast(1.2), kAtRest, 0);
        for (Return& r : robot.returns) {
          if (part(rng) > 0.01F) continue;
          const float drop = 0.3F + 0.6F * part(rng);
          r.x_m *= drop;
          r.y_m *= drop;
          r.z_m *= drop;
        }
        return with_robot(scan_at(test::road_with_posts(), kForward, k), robot);
      },
      is_mast);
  EXPECT_GT(of_mast.all, 500);
  EXPECT_LT(of_mast.left, 0.03 * static_cast<double>(of_mast.all)) << "the drops";
}

// It is flat like the ground, which is 1.4 m lower.
TEST(SelfFilter, LeavesOutARoofBehindTheSensor) {
  test::Scene plate;
  plate.planes = {{{0.0, 0.0, 1.0}, -0.4}};
  Scan roof = scan_at(plate, kAtRest, 0);
  std::erase_if(roof.returns, [](const Return& r) {
    return r.x_m > -1.0F || r.x_m < -3.5F || std::abs(r.y_m) > 0.9F;
  });
  const auto is_roof = [](const Feature& f) { return f.z_m > -0.5F && is_mast(f); };
  const Count of_roof = after_scans(
      [&](int k) { return with_robot(scan_at(test::road_with_posts(), kForward, k), roof); },
      is_roof);
  EXPECT_GT(of_roof.all, 100);
  EXPECT_EQ(of_roof.left, 0);
}

// A post beside a sensor at rest is steady, and so is all the rest.
TEST(SelfFilter, KeepsAPostWhileTheSensorRests) {
  const Count of_post = after_noisy_scans(mast(1.2), kAtRest);
  EXPECT_GT(of_post.all, 500);
  EXPECT_EQ(of_post.left, of_post.all);
}

// What is known stays known when the robot stops.
TEST(SelfFilter, LeavesOutTheRobotWhereItStopsToo) {
  const Drive stops = [](double t_s) {
    return Pose{so3_exp({}), {5.0 * std::min(t_s, 1.0), 0, 0}};
  };
  Filtered filtered;
  Count of_mast;
  for (int k = 0; k < 80; ++k) {
    of_mast = filtered.add(
        with_robot(scan_at(test::road_with_posts(), stops, k), scan_at(mast(1.2), kAtRest, 0)),
        is_mast);
  }
  EXPECT_GT(of_mast.all, 500);
  EXPECT_EQ(of_mast.left, 0);
}

// What is somewhere else in the next scan is not the robot.
TEST(SelfFilter, KeepsWhatHasMoved) {
  Filtered filtered;
  Count of_mast;
  for (int k = 0; k < kScans; ++k) {
    const double gap_m = k + 1 < kScans ? 1.2 : 1.4;
    const Scan robot = scan_at(mast(gap_m), kAtRest, 0);
    of_mast =
        filtered.add(with_robot(scan_at(test::road_with_posts(), kForward, k), robot), is_mast);
  }
  EXPECT_GT(of_mast.all, 500);
  EXPECT_EQ(of_mast.left, of_mast.all);
}

// Its ranges stay as they are, but it goes on beyond the robot.
TEST(SelfFilter, KeepsAWallAlongTheWay) {
  test::Scene road = test::road_with_posts();
  road.planes.push_back({{0.0, -1.0, 0.0}, -3.0});
  const Count of_wall = after_scans([&](int k) { return scan_at(road, kForward, k); },
                                    [](const Feature& f) { return f.y_m > 2.9F; });
  EXPECT_GT(of_wall.all, 3000);
  EXPECT_EQ(of_wall.left, of_wall.all);
}

// A lift is steady while something moves outside its door. To leave it out would leave little.
TEST(SelfFilter, KeepsALiftAroundTheSensor) {
  constexpr float kDoor_rad = 0.6F;
  const auto is_door = [](const Return& r) { return std::abs(r.azimuth_rad) < kDoor_rad; };
  test::Scene cabin;
  cabin.planes = {{{0.0, 0.0, 1.0}, -1.0}, {{0.0, 0.0, -1.0}, -1.3}, {{1.0, 0.0, 0.0}, -1.2},
                  {{0.0, 1.0, 0.0}, -1.2}, {{0.0, -1.0, 0.0}, -1.2}, {{-1.0, 0.0, 0.0}, -1.2}};
  Scan lift = scan_at(cabin, kAtRest, 0);
  std::erase_if(lift.returns, is_door);
  const Count of_lift = after_scans(
      [&](int k) {
        test::Scene hall;
        hall.planes = {{{-1.0, 0.0, 0.0}, 0.2 * k - 20.0}};
        Scan outside = scan_at(hall, kAtRest, k);
        std::erase_if(outside.returns, [&](const Return& r) { return !is_door(r); });
        return with_robot(outside, lift);
      },
      [](const Feature& f) { return std::hypot(f.x_m, f.y_m) < 2.0F; });
  EXPECT_GT(of_lift.all, 3000);
  EXPECT_EQ(of_lift.left, of_lift.all);
}

// While the scan is being measured, and whatever was measured before.
TEST(SelfFilter, LeavesOutTheSameInParts) {
  const Scan robot = scan_at(mast(0.85), kAtRest, 0);
  FeatureExtractor whole{OdometryConfig{}}, in_parts{OdometryConfig{}};
  int left_out = 0;
  for (int k = 0; k < kScans; ++k) {
    const Scan scan = with_robot(scan_at(test::road_with_posts(), kForward, k), robot);
    for (const std::size_t count : {5'000U, 9'000U, 14'000U}) {
      Scan part = scan;
      part.returns.resize(std::min(count, scan.returns.size()));
      in_parts.follow(part);
    }
    ScanFeatures of_whole, of_parts;
    whole.finish(scan, of_whole);
    in_parts.finish(scan, of_parts);
    ASSERT_EQ(of_whole.all.size(), of_parts.all.size()) << "scan " << k;
    for (std::size_t f = 0; f < of_whole.all.size(); ++f) {
      EXPECT_EQ(of_whole.all[f].ring, of_parts.all[f].ring);
      EXPECT_EQ(of_whole.all[f].x_m, of_parts.all[f].x_m);
    }
    left_out += std::none_of(of_whole.all.begin(), of_whole.all.end(), is_mast) ? 1 : 0;
  }
  EXPECT_EQ(left_out, kScans - 2) << "scans";
}

// Without the filter it ends 18 and 24 m off.
TEST(SelfFilter, AMastDoesNotHoldTheOdometryInPlace) {
  test::Scene road;
  road.planes = {{{0.0, 0.0, 1.0}, -1.8}};
  for (int k = 0; k < 5; ++k) road.poles.push_back({-20.0 + 17.0 * k, 9.0, 0.15, 3.0});
  const Scan robot = scan_at(mast(1.2), kAtRest, 0);
  for (const double at_rest_s : {1.0, 6.0}) {
    const Drive sets_off = [&](double t_s) {
      const double moving_s = std::max(0.0, t_s - at_rest_s);
      return Pose{so3_exp({}), {moving_s < 2.0 ? moving_s * moving_s : 4.0 * moving_s - 4.0, 0, 0}};
    };
    const int scans = static_cast<int>(10.0 * at_rest_s) + 50;
    Odometry odometry{OdometryConfig{}};
    Estimate e;
    for (int k = 0; k < scans; ++k) {
      e = odometry.process(with_robot(scan_at(road, sets_off, k), robot));
    }
    EXPECT_NEAR(e.T_odom_sensor.translation_m.x(), sets_off(0.1 * scans).translation_m.x(), 0.15)
        << at_rest_s << " s at rest";
  }
}

}  // namespace
}  // namespace lilo::core
