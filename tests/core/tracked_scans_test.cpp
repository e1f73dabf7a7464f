// SPDX-License-Identifier: BSD-3-Clause
// Six scans of nine posts, laid over each other under several motions.
#include "core/search/tracked_scans.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace lilo::core {
namespace {

constexpr int kPosts = 9;
constexpr int kScans = static_cast<int>(search::kMotionScans);
constexpr double kScan_s = 0.1;
constexpr double kSpeed_mps = 10.0;  // a post moves by two cells from scan to scan
constexpr double kSwing_rad = 0.05;  // in a scan; a post 100 m away moves by ten cells
constexpr int kNoLimit = std::numeric_limits<int>::max();

Pose at(double x_m) { return {Eigen::Quaterniond::Identity(), {x_m, 0.0, 0.0}}; }

/// What a sensor sees that drives along x: posts on its left, 25 m apart, in the middle of a cell.
/// Every other one is hit by the first firing, the others by the last.
std::vector<Feature> posts_seen(double speed_mps, double begin_s) {
  std::vector<Feature> features;
  for (int k = 0; k < kPosts; ++k) {
    Feature post{};
    post.s = static_cast<float>(k % 2);
    const double x_m = 25.0 * k - 99.75;
    post.x_m = static_cast<float>(x_m - speed_mps * (begin_s + kScan_s * (k % 2)));
    post.y_m = 20.25F;
    post.kind = FeatureKind::structure;
    features.push_back(post);
  }
  return features;
}

/// Scans of a sensor that drives at `true_mps`, tracked at `tracked_mps`.
TrackedScans scans_of(double true_mps, double tracked_mps) {
  TrackedScans scans(kPosts);
  StructurePoints structure;
  for (int k = 0; k < kScans; ++k) {
    const double begin_s = kScan_s * k, end_s = begin_s + kScan_s;
    structure.assign(posts_seen(true_mps, begin_s));
    scans.add(structure, at(tracked_mps * begin_s), at(tracked_mps * end_s),
              {std::llround(1e9 * begin_s), std::llround(1e9 * end_s)});
  }
  return scans;
}

/// Cells that all scans occupy under `faster_mps`.
int occupied(double true_mps, double tracked_mps, const Eigen::Vector2d& faster_mps,
             int limit = kNoLimit) {
  TopDownGrid grid(kPosts);
  return scans_of(true_mps, tracked_mps).occupied_under(faster_mps, Subsample::all, grid, limit);
}

TEST(TrackedScans, AtTheTrueSpeedEveryScanSeesTheSameCellsHoweverItWasTracked) {
  TopDownGrid grid(kPosts);
  for (const double tracked_mps : {0.0, kSpeed_mps, -3.0 * kSpeed_mps}) {
    const TrackedScans scans = scans_of(kSpeed_mps, tracked_mps);
    EXPECT_EQ(scans.occupied_at(kSpeed_mps, {1.0, 0.0}, Subsample::all, grid), kPosts);
    EXPECT_EQ(scans.occupied_at(-kSpeed_mps, {-1.0, 0.0}, Subsample::all, grid), kPosts);
    EXPECT_GT(scans.occupied_at(0.0, {1.0, 0.0}, Subsample::all, grid), kPosts);
    EXPECT_EQ(scans.occupied_at(0.0, {1.0, 0.0}, Subsample::all, grid, kPosts), kPosts);
  }
}

TEST(TrackedScans, AcrossTheAxisTheMotionIsThatTracked) {
  TopDownGrid grid(kPosts);
  const Eigen::Vector2d oblique(0.6, 0.8);
  EXPECT_EQ(
      scans_of(kSpeed_mps, kSpeed_mps).occupied_at(0.6 * kSpeed_mps, oblique, Subsample::all, grid),
      kPosts);
  EXPECT_EQ(scans_of(kSpeed_mps, kSpeed_mps).occupied_at(0.0, {0.0, 1.0}, Subsample::all, grid),
            kPosts);
  EXPECT_GT(scans_of(kSpeed_mps, 0.0).occupied_at(0.0, {0.0, 1.0}, Subsample::all, grid), kPosts);
}

TEST(TrackedScans, UnderTheTrueMotionEveryScanSeesTheSameCells) {
  EXPECT_EQ(occupied(0.0, 0.0, {0.0, 0.0}), kPosts);
  EXPECT_EQ(occupied(kSpeed_mps, kSpeed_mps, {0.0, 0.0}), kPosts);
  EXPECT_EQ(occupied(kSpeed_mps, 0.0, {kSpeed_mps, 0.0}), kPosts);
  EXPECT_EQ(occupied(0.0, kSpeed_mps, {-kSpeed_mps, 0.0}), kPosts);
}

TEST(TrackedScans, UnderAnotherMotionEveryScanHasCellsOfItsOwn) {
  EXPECT_EQ(occupied(kSpeed_mps, 0.0, {0.0, 0.0}), kScans * kPosts);
  EXPECT_EQ(occupied(kSpeed_mps, 0.0, {-kSpeed_mps, 0.0}), kScans * kPosts);
  EXPECT_EQ(occupied(0.0, 0.0, {0.0, kSpeed_mps}), kScans * kPosts);
}

/// By hand a sensor looks to the left and to the right: from scan to scan the yaw rate changes its
/// sign, and the first firing of a scan sees a post elsewhere than the last one would.
TEST(TrackedScans, ASensorThatSwingsSeesTheSameCells) {
  TrackedScans scans(kPosts);
  TopDownGrid grid(kPosts);
  StructurePoints structure;
  const auto turned = [](double yaw_rad) {
    return Pose{Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())),
                Eigen::Vector3d::Zero()};
  };
  for (int k = 0; k < kScans; ++k) {
    const double begin_s = kScan_s * k, end_s = begin_s + kScan_s;
    const std::array<Pose, 2> T_at_s{turned(k % 2 == 0 ? 0.0 : kSwing_rad),
                                     turned(k % 2 == 0 ? kSwing_rad : 0.0)};
    std::vector<Feature> features = posts_seen(0.0, begin_s);
    for (Feature& post : features) {
      const Pose& T = T_at_s[static_cast<std::size_t>(post.s)];
      const Eigen::Vector3d seen_m =
          T.inverse() * Eigen::Vector3f(post.x_m, post.y_m, post.z_m).cast<double>();
      post.x_m = static_cast<float>(seen_m.x());
      post.y_m = static_cast<float>(seen_m.y());
    }
    structure.assign(features);
    scans.add(structure, T_at_s[0], T_at_s[1],
              {std::llround(1e9 * begin_s), std::llround(1e9 * end_s)});
  }
  EXPECT_EQ(scans.occupied_under({0.0, 0.0}, Subsample::all, grid, kNoLimit), kPosts);
}

TEST(TrackedScans, GivesTheLimitWhereThereAreAsManyOrMore) {
  EXPECT_EQ(occupied(0.0, 0.0, {kSpeed_mps, 0.0}, kScans * kPosts + 1), kScans * kPosts);
  for (const int limit : {1, kPosts, 2 * kPosts + 1, kScans * kPosts}) {
    EXPECT_EQ(occupied(0.0, 0.0, {kSpeed_mps, 0.0}, limit), limit);
  }
  EXPECT_EQ(occupied(0.0, 0.0, {0.0, 0.0}, kPosts + 1), kPosts);
}

}  // namespace
}  // namespace lilo::core
