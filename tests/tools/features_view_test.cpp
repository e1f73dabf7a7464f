// SPDX-License-Identifier: BSD-3-Clause
#include "tools/plot/features_view.hpp"

#include "tools/eval/error_track.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lilo {
namespace {

TEST(SeenFromAbove, StraightDownIsAMap) {
  const Eigen::Vector2d at = seen_from_above({3.0, 2.0, 7.0}, std::numbers::pi / 2.0);
  EXPECT_NEAR(at.x(), -2.0, 1e-12);  // left is to the left
  EXPECT_NEAR(at.y(), 3.0, 1e-12);   // ahead is up
}

TEST(SeenFromAbove, AtTheHorizonHeightIsUp) {
  const Eigen::Vector2d at = seen_from_above({3.0, 2.0, 7.0}, 0.0);
  EXPECT_NEAR(at.y(), 7.0, 1e-12);
}

/// A cylinder of 10 m around the sensor, but for a post at 4 m straight to the left.
Scan scan_with_post() {
  Scan scan;
  scan.beams.ring_count = 16;
  for (int ring = 0; ring < 16; ++ring) {
    const float elevation = static_cast<float>(2 * ring - 15) * 0.0174533F;
    scan.beams.elevation_rad.at(static_cast<std::size_t>(ring)) = elevation;
    for (int k = 0; k < 720; ++k) {
      const float azimuth = (static_cast<float>(k) - 360.0F) * 0.00872665F;  // at pixel centres
      const float r = std::abs(azimuth - 1.5708F) < 0.03F ? 4.0F : 10.0F;
      scan.returns.push_back({.x_m = r * std::cos(azimuth) * std::cos(elevation),
                              .y_m = r * std::sin(azimuth) * std::cos(elevation),
                              .z_m = r * std::sin(elevation),
                              .azimuth_rad = azimuth,
                              .ring = static_cast<std::uint8_t>(ring)});
    }
  }
  return scan;
}

bool is_red(const cv::Vec3b& bgr) { return bgr[2] > 150 && bgr[0] < 90 && bgr[1] < 90; }

/// The post's sides are edges: in the map they are red, 4 m to the left of the sensor and nowhere
/// else, for the cylinder has none.
TEST(FeaturesView, EdgesAreRedWhereTheyAre) {
  const cv::Mat picture = draw_features(scan_with_post(), {}, "post").image();
  int left = 0, elsewhere = 0;
  const int map_top = picture.rows - 752, map_right = 32 + 756;
  const int centre = 32 + 378;
  for (int y = map_top; y < picture.rows - 32; ++y) {
    for (int x = 32; x < map_right; ++x) {
      if (!is_red(picture.at<cv::Vec3b>(y, x))) continue;
      const bool there = x < centre - 40 && std::abs(y - (map_top + 360)) < 30;
      ++(there ? left : elsewhere);
    }
  }
  EXPECT_GT(left, 10);
  EXPECT_EQ(elsewhere, 0);
}

TEST(FeaturesView, AnEmptyScanIsDrawn) {
  Scan scan;
  scan.beams.ring_count = 16;
  EXPECT_EQ(draw_features(scan, {}, "empty").width(), 1600);
}

/// One metre a pose; the estimate yaws by 1 degree at its second pose and is told in a frame that
/// is turned and moved, which must not matter.
TEST(ErrorTrack, GrowsWithTheDistanceSinceTheFirstPose) {
  const Pose T_world_odom{so3_exp({0.0, 0.0, 1.2}), {5.0, -3.0, 1.0}};
  const double degree = std::numbers::pi / 180.0;
  Matched poses;
  for (int k = 0; k < 5; ++k) {
    const Eigen::Vector3d at(k, 0.0, 0.0);
    poses.truth.push_back(T_world_odom * Pose{Eigen::Quaterniond::Identity(), at});
    const Pose bent{so3_exp({0.0, 0.0, k > 0 ? degree : 0.0}), {1.0 * k, 0.0, 0.1 * k}};
    poses.estimate.push_back(bent);
  }
  const std::vector<ErrorPoint> track = error_track(poses);
  ASSERT_EQ(track.size(), 5U);
  EXPECT_NEAR(track[0].error_m, 0.0, 1e-12);
  EXPECT_NEAR(track[4].distance_m, 4.0, 1e-12);
  EXPECT_NEAR(track[4].error_m, 0.4, 1e-9);
  EXPECT_NEAR(track[4].error_deg, 1.0, 1e-9);
  EXPECT_LT((track[4].truth_m - Eigen::Vector3d(4, 0, 0)).norm(), 1e-9);
  EXPECT_EQ(error_table(track).rows.size(), 5U);
  EXPECT_EQ(error_table(track).rows[4][7], "0.4000");
}

}  // namespace
}  // namespace lilo
