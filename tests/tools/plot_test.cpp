// SPDX-License-Identifier: BSD-3-Clause
#include "tools/plot/density_image.hpp"
#include "tools/plot/map_points.hpp"
#include "tools/plot/scan_view.hpp"
#include "tools/plot/trajectory_view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace lilo {
namespace {

/// The sensor drives along x at 10 m/s past a post at (5, 3), seen once in every millisecond.
Scan scan_of_post(double start_s) {
  Scan scan;
  scan.start_ns = static_cast<std::int64_t>(start_s * 1e9);
  scan.end_ns = scan.start_ns + 99'000'000;
  for (int k = 0; k <= 99; ++k) {
    const double x = 10.0 * (start_s + 1e-3 * k);
    scan.returns.push_back(
        {.x_m = static_cast<float>(5.0 - x), .y_m = 3.0F, .t_ns = k * 1'000'000});
  }
  return scan;
}

TEST(MapPoints, ReturnsAreMovedToTheirOwnFiringTime) {
  MapPoints map;
  for (int k = 0; k < 5; ++k) {
    const Scan scan = scan_of_post(0.1 * k);
    map.add(scan, {.translation_m = {10.0 * 1e-9 * static_cast<double>(scan.end_ns), 0, 0}});
  }
  ASSERT_GT(map.points().size(), 200U);
  for (std::size_t k = 100; k < map.points().size(); ++k) {  // the first scan's motion is unknown
    EXPECT_NEAR(map.points()[k].x(), 5.0, 0.02);
    EXPECT_NEAR(map.points()[k].y(), 3.0, 1e-6);
  }
}

TEST(MapPoints, StandstillAddsNothing) {
  MapPoints map;
  for (int k = 0; k < 100; ++k) map.add(scan_of_post(0.1 * k), {});
  EXPECT_EQ(map.points().size(), 100U);
}

TEST(DensityImage, ColoursOnlyPixelsWithDots) {
  const Color background{1, 2, 3};
  const cv::Mat3b image =
      density_image(10, 5, {{3.5, 2.5, 0.0}, {-1.0, 0.0, 0.0}, {10.0, 5.0, 0.0}}, background);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 10; ++x) {
      const bool empty = image(y, x) == cv::Vec3b(3, 2, 1);
      EXPECT_EQ(empty, !(x == 3 && y == 2)) << x << " " << y;
    }
  }
}

TEST(TrajectoryView, LaysTheTruthOverTheFirstCommonPose) {
  Trajectory estimate{.name = "estimate", .has_times = true}, truth{.name = "t", .has_times = true};
  const Pose frame{so3_exp({0, 0, 1.0}), {4, 5, 6}};
  for (int k = 0; k < 30; ++k) {
    const Pose pose{.translation_m = {1.0 * k, 0, 0}};
    estimate.poses.push_back({k * 100'000'000LL, pose});
    truth.poses.push_back({k * 100'000'000LL, frame * pose});
  }
  const TopView view = trajectory_view("title", {estimate}, truth, {});
  ASSERT_TRUE(view.truth);
  for (std::size_t k = 0; k < 30; ++k) {
    EXPECT_LT((view.truth->positions_m[k] - view.tracks[0].positions_m[k]).norm(), 1e-9);
  }
  EXPECT_NE(view.subtitle.find("29.0 m in 30 poses"), std::string::npos) << view.subtitle;
  EXPECT_NE(view.subtitle.find("drift 0.00 %"), std::string::npos) << view.subtitle;
}

TEST(Draw, EmptyInputGivesAPictureAndNoCrash) {
  EXPECT_FALSE(draw(TopView{}).image().empty());
  EXPECT_FALSE(draw(Scan{}, "empty").image().empty());
  EXPECT_THROW(draw(TopView{}).save("/no/such/folder/map.png"), std::runtime_error);
}

}  // namespace
}  // namespace lilo
