// SPDX-License-Identifier: BSD-3-Clause
#include "core/odometry.hpp"
#include "tests/core/analytic_scene.hpp"
#include "tests/core/profiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace lilo {
namespace {

class MapPoints : public testing::TestWithParam<Profile> {};

// Standing in the yard: every point lies on one of its planes or poles, give or take a cell.
TEST_P(MapPoints, LieOnTheScene) {
  OdometryConfig config;
  config.profile = GetParam();
  Odometry odometry(config);
  EXPECT_TRUE(odometry.map_points().empty());
  const test::Scene scene = test::yard();
  for (std::uint64_t k = 0; k < 5; ++k) {
    odometry.process(test::scan_of(
        scene, test::even_beams(16, -15.0, 15.0), 900, [](double) { return Pose{}; }, k));
  }
  const std::vector<Eigen::Vector3f> points_m = odometry.map_points();
  EXPECT_GT(points_m.size(), 300U);
  for (const Eigen::Vector3f& point : points_m) {
    const Eigen::Vector3d p = point.cast<double>();
    double nearest_m = 1e9;
    for (const auto& plane : scene.planes)
      nearest_m = std::min(nearest_m, std::abs(plane.normal.dot(p) - plane.offset_m));
    for (const auto& pole : scene.poles)
      nearest_m = std::min(nearest_m, std::hypot(p.x() - pole.x_m, p.y() - pole.y_m));
    ASSERT_LT(nearest_m, 0.5) << p.transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(Profiles, MapPoints, testing::ValuesIn(test::profiles()),
                         [](const auto& test) {
                           return test.param == Profile::paper ? "paper" : "default";
                         });

}  // namespace
}  // namespace lilo
