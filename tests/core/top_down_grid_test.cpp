// SPDX-License-Identifier: BSD-3-Clause
#include "core/search/top_down_grid.hpp"

#include "core/image/feature_image.hpp"
#include "core/motion/trajectory.hpp"
#include "tests/core/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace lilo::core {
namespace {

constexpr double kSpan_s = 0.1;

/// Two scans from a sensor in constant motion, as features; the first firing of the first one is
/// from the origin.
std::vector<std::vector<Feature>> two_scans(const Twist& twist) {
  FeatureImage image(1024, {});
  std::vector<std::vector<Feature>> scans;
  for (int k = 0; k < 2; ++k) {
    const Scan scan = test::scan_of(
        test::road_with_posts(), test::even_beams(16, -15.0, 15.0), 900,
        [&](double s) {
          const double t_s = kSpan_s * (k + s);
          return Pose{so3_exp(t_s * twist.angular_radps), t_s * twist.linear_mps};
        },
        static_cast<std::uint64_t>(k));
    scans.push_back(image.build(scan));
  }
  return scans;
}

int occupied_under(const std::vector<std::vector<Feature>>& scans, const Twist& supposed,
                   Subsample subsample = Subsample::all) {
  TopDownGrid grid(100000);
  StructurePoints points;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const double begin_s = kSpan_s * static_cast<double>(k);
    points.assign(scans[k]);
    const Pose begin = moved({}, supposed, begin_s), end = moved({}, supposed, begin_s + kSpan_s);
    TopDownPoints from_above;
    from_above.assign(points, begin.rotation, end.rotation, subsample);
    grid.add(from_above, begin.translation_m.head<2>(), end.translation_m.head<2>(), subsample);
  }
  return grid.occupied();
}

Twist ahead(double speed_mps) {
  Twist twist;
  twist.linear_mps.x() = speed_mps;
  return twist;
}

TEST(TopDownGrid, IsLeastUnderTheTrueSpeed) {
  for (const double true_mps : {0.0, 10.0, 25.0}) {
    const auto scans = two_scans(ahead(true_mps));
    for (const Subsample subsample : {Subsample::all, Subsample::quarter}) {
      const int at_truth = occupied_under(scans, ahead(true_mps), subsample);
      for (const double other_mps : {-10.0, 0.0, 10.0, 25.0, 35.0}) {
        if (other_mps == true_mps) continue;
        EXPECT_LT(at_truth, occupied_under(scans, ahead(other_mps), subsample))
            << true_mps << " m/s driven, " << other_mps << " m/s supposed";
      }
    }
  }
}

TEST(TopDownGrid, CountsPointsOnOccupiedCells) {
  TopDownPoints from_above;
  from_above.x = {0.5F, 20.5F, 240.5F,
                  -600.5F};  // cells: two inside, one near the end, one beyond it
  from_above.y = {0.5F, -9.5F, 0.5F, 0.5F};
  from_above.s = {0.0F, 0.0F, 0.0F, 0.0F};
  TopDownGrid map(100);
  map.place(from_above, {0.0, 0.0}, {0.0, 0.0}, Subsample::all, 20);
  EXPECT_EQ(map.hits(0, 0), 0) << "nothing was added";
  map.add({10.25, -4.75}, 1);  // cell 20.5, -9.5
  map.add({120.25, 0.25}, 0);
  EXPECT_EQ(map.hits(0, 0), 1);
  EXPECT_EQ(map.hits(1, -1), 1) << "as far around as was asked for";
  EXPECT_EQ(map.hits(2, 0), 0);
  EXPECT_EQ(map.hits(20, -10), 1) << "the other return";
  map.place(from_above, {0.0, 0.0}, {0.0, 0.0}, Subsample::all, 1);
  EXPECT_EQ(map.hits(0, 0), 2) << "with less of a margin";
  map.clear();
  EXPECT_EQ(map.hits(0, 0), 0);
}

TEST(StructurePoints, BeginsWithEveryFourth) {
  std::vector<Feature> features(20);
  std::vector<float> all_m;
  for (std::size_t k = 0; k < features.size(); ++k) {
    features[k].x_m = static_cast<float>(k);
    features[k].kind = k % 2 == 0 ? FeatureKind::structure : FeatureKind::ground;
    if (k % 2 == 0) all_m.push_back(features[k].x_m);
  }
  StructurePoints points;
  points.assign(features);
  const std::size_t first = StructurePoints::before(1, points.x_m.size());
  const std::vector<float> quarter_m(points.x_m.begin(),
                                     points.x_m.begin() + static_cast<std::ptrdiff_t>(first));
  EXPECT_EQ(quarter_m, (std::vector<float>{0.0F, 8.0F, 16.0F}));
  EXPECT_TRUE(
      std::is_permutation(points.x_m.begin(), points.x_m.end(), all_m.begin(), all_m.end()));
}

TEST(TopDownGrid, OfTheSameScanTwiceIsThatOfOne) {
  auto scans = two_scans(ahead(0.0));
  scans[1] = scans[0];
  const int once = occupied_under({scans[0]}, ahead(0.0));
  EXPECT_GT(once, 0);
  EXPECT_EQ(occupied_under(scans, ahead(0.0)), once);
}

TEST(TopDownGrid, GroundOccupiesNothing) {
  Feature ground{};
  ground.x_m = 5.0F;
  ground.kind = FeatureKind::ground;
  EXPECT_EQ(occupied_under({{ground}}, ahead(0.0)), 0);
  ground.kind = FeatureKind::structure;
  EXPECT_EQ(occupied_under({{ground}}, ahead(0.0)), 1);
}

TopDownPoints seen_from_above(const std::vector<Feature>& features) {
  StructurePoints points;
  points.assign(features);
  TopDownPoints from_above;
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  from_above.assign(points, level, level, Subsample::all);
  return from_above;
}

Feature post_at(float x_m, float y_m) {
  Feature post{};
  post.x_m = x_m;
  post.y_m = y_m;
  post.kind = FeatureKind::structure;
  return post;
}

TEST(TopDownGrid, LeavesOutWhatIsFar) {
  const TopDownPoints far =
      seen_from_above({post_at(129.0F, 0.0F), post_at(-129.0F, 0.0F), post_at(0.0F, 129.0F),
                       post_at(0.0F, -129.0F), post_at(-1e9F, 1e9F)});
  const TopDownPoints near = seen_from_above({post_at(127.0F, 0.0F), post_at(-127.0F, 0.0F),
                                              post_at(0.0F, 127.0F), post_at(0.0F, -127.0F)});
  TopDownGrid grid(10);
  grid.add(far, {0.0, 0.0}, {0.0, 0.0});
  EXPECT_EQ(grid.occupied(), 0);
  grid.add(near, {0.0, 0.0}, {0.0, 0.0});
  EXPECT_EQ(grid.occupied(), 4);
}

TEST(TopDownGrid, ForgetsWhatWasBeforeClear) {
  const TopDownPoints post = seen_from_above({post_at(5.0F, 0.0F)}),
                      other = seen_from_above({post_at(9.0F, 0.0F)});
  TopDownGrid grid(10);
  grid.add(post, {0.0, 0.0}, {0.0, 0.0});
  // Longer than any count of them goes on without beginning again.
  for (int times = 0; times < 1000; ++times) {
    grid.clear();
    grid.add(other, {0.0, 0.0}, {0.0, 0.0});
    ASSERT_EQ(grid.occupied(), 1);
  }
  for (int times = 0; times < 1000; ++times) {
    grid.clear();
    ASSERT_EQ(grid.occupied(), 0);
    if (times % 255 == 0) {
      grid.add(post, {0.0, 0.0}, {0.0, 0.0});
      ASSERT_EQ(grid.occupied(), 1);
    }
  }
}

TEST(TopDownGrid, LeavesOutWhatNoCellCanHold) {
  const auto scans = two_scans({});
  ASSERT_GT(occupied_under(scans, {}), 0);
  for (const double far_m : {1e12, -1e12, 1e30, std::numeric_limits<double>::quiet_NaN()}) {
    TopDownGrid grid(100000);
    StructurePoints points;
    points.assign(scans[0]);
    TopDownPoints from_above;
    from_above.assign(points, Eigen::Quaterniond::Identity(), Eigen::Quaterniond::Identity(),
                      Subsample::all);
    const Eigen::Vector2d there_m(far_m, far_m);
    grid.add(from_above, there_m, there_m, Subsample::all);
    grid.add(there_m, 1);
    EXPECT_EQ(grid.occupied(), 0) << far_m;
  }
}

}  // namespace
}  // namespace lilo::core
