#include "core/search/footprint.hpp"

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

test::Scene road_with_posts() {
  test::Scene road;
  road.planes = {{{0.0, 0.0, 1.0}, -1.8}};
  for (int k = 0; k < 24; ++k) {
    const double along_m = -100.0 + 11.0 * k + 3.0 * std::sin(2.0 * k);
    road.poles.push_back({along_m, k % 2 == 0 ? 9.0 : -7.0, 0.25, 3.0});
  }
  return road;
}

/// Two scans from a sensor in constant motion, as features; the first firing of the first one is
/// from the origin.
std::vector<std::vector<Feature>> two_scans(const Twist& twist) {
  FeatureImage image(1024, {});
  std::vector<std::vector<Feature>> scans;
  for (int k = 0; k < 2; ++k) {
    const Scan scan = test::scan_of(
        road_with_posts(), test::even_beams(16, -15.0, 15.0), 900,
        [&](double s) {
          const double t_s = kSpan_s * (k + s);
          return Pose{so3_exp(t_s * twist.angular_radps), t_s * twist.linear_mps};
        },
        static_cast<std::uint64_t>(k));
    scans.push_back(image.build(scan));
  }
  return scans;
}

int cells_under(const std::vector<std::vector<Feature>>& scans, const Twist& supposed,
                Share share = Share::all) {
  Footprint footprint(100000);
  Outline outline;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const double begin_s = kSpan_s * static_cast<double>(k);
    outline.assign(scans[k]);
    const Pose begin = moved({}, supposed, begin_s), end = moved({}, supposed, begin_s + kSpan_s);
    Plan plan;
    plan.assign(outline, begin.rotation, end.rotation, share);
    footprint.add(plan, begin.translation_m.head<2>(), end.translation_m.head<2>(), share);
  }
  return footprint.cells();
}

Twist ahead(double speed_mps) {
  Twist twist;
  twist.linear_mps.x() = speed_mps;
  return twist;
}

TEST(Footprint, IsLeastUnderTheTrueSpeed) {
  for (const double true_mps : {0.0, 10.0, 25.0}) {
    const auto scans = two_scans(ahead(true_mps));
    for (const Share share : {Share::all, Share::quarter}) {
      const int at_truth = cells_under(scans, ahead(true_mps), share);
      for (const double other_mps : {-10.0, 0.0, 10.0, 25.0, 35.0}) {
        if (other_mps == true_mps) continue;
        EXPECT_LT(at_truth, cells_under(scans, ahead(other_mps), share))
            << true_mps << " m/s driven, " << other_mps << " m/s supposed";
      }
    }
  }
}

TEST(Footprint, CountsReturnsOnWhatWasAdded) {
  Plan plan;
  plan.x = {0.5F, 20.5F, 240.5F, -600.5F};  // cells: two inside, one near the end, one beyond it
  plan.y = {0.5F, -9.5F, 0.5F, 0.5F};
  plan.s = {0.0F, 0.0F, 0.0F, 0.0F};
  Footprint map(100);
  map.aim(plan, {0.0, 0.0}, {0.0, 0.0}, Share::all, 20);
  EXPECT_EQ(map.returns_on(0, 0), 0) << "nothing was added";
  map.add({10.25, -4.75}, 1);  // cell 20.5, -9.5
  map.add({120.25, 0.25}, 0);
  EXPECT_EQ(map.returns_on(0, 0), 1);
  EXPECT_EQ(map.returns_on(1, -1), 1) << "as far around as was asked for";
  EXPECT_EQ(map.returns_on(2, 0), 0);
  EXPECT_EQ(map.returns_on(20, -10), 1) << "the other return";
  map.aim(plan, {0.0, 0.0}, {0.0, 0.0}, Share::all, 1);
  EXPECT_EQ(map.returns_on(0, 0), 2) << "with less of a margin";
  map.clear();
  EXPECT_EQ(map.returns_on(0, 0), 0);
}

TEST(Outline, BeginsWithEveryFourth) {
  std::vector<Feature> features(20);
  std::vector<float> all_m;
  for (std::size_t k = 0; k < features.size(); ++k) {
    features[k].x_m = static_cast<float>(k);
    features[k].kind = k % 2 == 0 ? FeatureKind::structure : FeatureKind::ground;
    if (k % 2 == 0) all_m.push_back(features[k].x_m);
  }
  Outline outline;
  outline.assign(features);
  const std::size_t first = Outline::before(1, outline.x_m.size());
  const std::vector<float> quarter_m(outline.x_m.begin(),
                                     outline.x_m.begin() + static_cast<std::ptrdiff_t>(first));
  EXPECT_EQ(quarter_m, (std::vector<float>{0.0F, 8.0F, 16.0F}));
  EXPECT_TRUE(
      std::is_permutation(outline.x_m.begin(), outline.x_m.end(), all_m.begin(), all_m.end()));
}

TEST(Footprint, OfTheSameScanTwiceIsThatOfOne) {
  auto scans = two_scans(ahead(0.0));
  scans[1] = scans[0];
  const int once = cells_under({scans[0]}, ahead(0.0));
  EXPECT_GT(once, 0);
  EXPECT_EQ(cells_under(scans, ahead(0.0)), once);
}

TEST(Footprint, GroundTakesNoRoom) {
  Feature ground{};
  ground.x_m = 5.0F;
  ground.kind = FeatureKind::ground;
  EXPECT_EQ(cells_under({{ground}}, ahead(0.0)), 0);
  ground.kind = FeatureKind::structure;
  EXPECT_EQ(cells_under({{ground}}, ahead(0.0)), 1);
}

Plan plan_of(const std::vector<Feature>& features) {
  Outline outline;
  outline.assign(features);
  Plan plan;
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  plan.assign(outline, level, level);
  return plan;
}

Feature post_at(float x_m, float y_m) {
  Feature post{};
  post.x_m = x_m;
  post.y_m = y_m;
  post.kind = FeatureKind::structure;
  return post;
}

TEST(Footprint, LeavesOutWhatIsFar) {
  const Plan far = plan_of({post_at(129.0F, 0.0F), post_at(-129.0F, 0.0F), post_at(0.0F, 129.0F),
                            post_at(0.0F, -129.0F), post_at(-1e9F, 1e9F)});
  const Plan near = plan_of({post_at(127.0F, 0.0F), post_at(-127.0F, 0.0F), post_at(0.0F, 127.0F),
                             post_at(0.0F, -127.0F)});
  Footprint footprint(10);
  footprint.add(far, {0.0, 0.0}, {0.0, 0.0});
  EXPECT_EQ(footprint.cells(), 0);
  footprint.add(near, {0.0, 0.0}, {0.0, 0.0});
  EXPECT_EQ(footprint.cells(), 4);
}

TEST(Footprint, ForgetsWhatWasBeforeClear) {
  const Plan post = plan_of({post_at(5.0F, 0.0F)}), other = plan_of({post_at(9.0F, 0.0F)});
  Footprint footprint(10);
  footprint.add(post, {0.0, 0.0}, {0.0, 0.0});
  // Longer than any count of them goes on without beginning again.
  for (int times = 0; times < 1000; ++times) {
    footprint.clear();
    footprint.add(other, {0.0, 0.0}, {0.0, 0.0});
    ASSERT_EQ(footprint.cells(), 1);
  }
  for (int times = 0; times < 1000; ++times) {
    footprint.clear();
    ASSERT_EQ(footprint.cells(), 0);
    if (times % 255 == 0) {
      footprint.add(post, {0.0, 0.0}, {0.0, 0.0});
      ASSERT_EQ(footprint.cells(), 1);
    }
  }
}

TEST(Footprint, LeavesOutWhatNoCellCanHold) {
  const auto scans = two_scans({});
  ASSERT_GT(cells_under(scans, {}), 0);
  for (const double far_m : {1e12, -1e12, 1e30, std::numeric_limits<double>::quiet_NaN()}) {
    Footprint footprint(100000);
    Outline outline;
    outline.assign(scans[0]);
    Plan plan;
    plan.assign(outline, Eigen::Quaterniond::Identity(), Eigen::Quaterniond::Identity(),
                Share::all);
    const Eigen::Vector2d there_m(far_m, far_m);
    footprint.add(plan, there_m, there_m, Share::all);
    footprint.add(there_m, 1);
    EXPECT_EQ(footprint.cells(), 0) << far_m;
  }
}

}  // namespace
}  // namespace lilo::core
