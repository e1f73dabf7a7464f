// SPDX-License-Identifier: BSD-3-Clause
#include "core/odometry.hpp"
#include "tests/core/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace lilo {
namespace {

/// Driving forward through the yard.
Pose drive(double t_s) { return {so3_exp({0.0, 0.0, 0.05 * t_s}), {4.0 * t_s - 6.0, 0.0, 0.0}}; }

double distance_m(const test::Scene& scene, const Eigen::Vector3d& p) {
  double nearest_m = 1e9;
  for (const auto& plane : scene.planes)
    nearest_m = std::min(nearest_m, std::abs(plane.normal.dot(p) - plane.offset_m));
  for (const auto& pole : scene.poles) {
    const double to_axis_m = std::hypot(p.x() - pole.x_m, p.y() - pole.y_m);
    nearest_m = std::min(nearest_m, std::abs(to_axis_m - pole.radius_m));
  }
  return nearest_m;
}

// The true pose of the scan's end takes them to the surfaces they were measured on: they are told
// at that instant, though the sensor moved 0.4 m meanwhile.
TEST(SeenPoints, LieOnTheSceneFromThePoseOfTheirScan) {
  OdometryConfig config;
  config.default_profile.keyframe_m = 0.3;  // so that every scan is a keyframe
  Odometry odometry{config};
  const test::Scene scene = test::yard();
  std::vector<Eigen::Vector3f> aligned_m, mapped_m;
  std::size_t aligned = 0, mapped = 0;
  for (std::uint64_t k = 0; k < 15; ++k) {
    const double at_s = 0.1 * static_cast<double>(k);
    odometry.process(test::scan_of(
        scene, test::even_beams(16, -15.0, 15.0), 900,
        [&](double s) { return drive(at_s + 0.1 * s); }, k));
    if (k < 8) continue;  // the motion at the start is found by then
    odometry.aligned_points(300, aligned_m);
    odometry.mapped_points(200, mapped_m);
    EXPECT_EQ(aligned_m.size(), 300U);
    EXPECT_LE(mapped_m.size(), 200U);
    aligned += aligned_m.size();
    mapped += mapped_m.size();
    for (const auto& points_m : {aligned_m, mapped_m}) {
      for (const Eigen::Vector3f& p_m : points_m)
        ASSERT_LT(distance_m(scene, drive(at_s + 0.1) * p_m.cast<double>()), 0.1);
    }
  }
  EXPECT_GT(aligned, 2000U);
  EXPECT_GT(mapped, 500U) << "it drove, so the map grew";
}

// Few of them still look into every direction.
TEST(SeenPoints, AreSpreadEvenly) {
  Odometry odometry{OdometryConfig{}};
  for (std::uint64_t k = 0; k < 3; ++k) {
    odometry.process(test::scan_of(
        test::yard(), test::even_beams(16, -15.0, 15.0), 900, [](double) { return Pose{}; }, k));
  }
  std::vector<Eigen::Vector3f> points_m;
  odometry.aligned_points(80, points_m);
  std::array<int, 8> in_octant{};
  for (const Eigen::Vector3f& p_m : points_m) {
    constexpr float kPi = std::numbers::pi_v<float>;
    const float part = (std::atan2(p_m.y(), p_m.x()) + kPi) / (2.0F * kPi);
    ++in_octant[std::min<std::size_t>(static_cast<std::size_t>(part * 8.0F), 7)];
  }
  for (const int count : in_octant) EXPECT_GE(count, 4);
}

// Standing, the map does not grow after its first scans.
TEST(SeenPoints, OfTheMapAreThoseThatCameWithTheLastScan) {
  Odometry odometry{OdometryConfig{}};
  std::vector<Eigen::Vector3f> points_m{Eigen::Vector3f::Zero()};
  for (std::uint64_t k = 0; k < 12; ++k) {
    odometry.process(test::scan_of(
        test::yard(), test::even_beams(16, -15.0, 15.0), 900, [](double) { return Pose{}; }, k));
    odometry.mapped_points(100, points_m);
    if (k == 0) {
      EXPECT_EQ(points_m.size(), 100U);
    }
  }
  EXPECT_TRUE(points_m.empty());
}

TEST(SeenPoints, AreNoneInProfilePaper) {
  if (!has_profile(Profile::paper)) GTEST_SKIP() << "this build has no profile paper";
  OdometryConfig config;
  config.profile = Profile::paper;
  Odometry odometry(config);
  odometry.process(test::scan_of(test::yard(), test::even_beams(16, -15.0, 15.0), 900,
                                 [](double) { return Pose{}; }));
  std::vector<Eigen::Vector3f> points_m{Eigen::Vector3f::Zero()};
  odometry.aligned_points(100, points_m);
  EXPECT_TRUE(points_m.empty());
}

}  // namespace
}  // namespace lilo
