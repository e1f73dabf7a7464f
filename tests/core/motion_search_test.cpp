// SPDX-License-Identifier: BSD-3-Clause
#include "core/search/motion_search.hpp"

#include "tests/core/observed_scan.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>
#include <vector>

namespace lilo::core {
namespace {

constexpr std::size_t kMost = 40000;

void add_scans(MotionSearch& search, const test::Scene& scene, double speed_mps, int count) {
  for (int k = 0; k < count; ++k) {
    const auto index = static_cast<std::uint64_t>(k);
    const test::ObservedScan scan(scene, test::along_x(speed_mps, index), index);
    search.add(scan.timing(), scan.features());
  }
}

TEST(MotionSearch, FindsTheSpeedOfAStartInMotion) {
  for (const double speed_mps : {5.0, 15.0, 28.0}) {
    MotionSearch search(kMost);
    add_scans(search, test::road_with_posts(), speed_mps, 4);
    const MotionSearch::Result result = search.find();
    EXPECT_TRUE(result.moves && result.shares_enough) << speed_mps;
    EXPECT_NEAR(result.twist.linear_mps.x(), speed_mps, 0.5);
    EXPECT_NEAR(result.twist.linear_mps.y(), 0.0, 1.1);  // less than a cell in four scans
    EXPECT_NEAR(result.twist.angular_radps.z(), 0.0, 0.1);
  }
}

TEST(MotionSearch, ASensorAtRestIsStationaryBeyondDoubt) {
  MotionSearch search(kMost);
  add_scans(search, test::yard(), 0.0, 2);
  const MotionSearch::Result result = search.find();
  EXPECT_FALSE(result.moves);
  EXPECT_TRUE(result.is_unambiguous);
  EXPECT_EQ(result.twist.linear_mps, Eigen::Vector3d::Zero().eval());
}

// A sensor that is covered, or whose motor starts.
TEST(MotionSearch, ScansWithoutReturnsTellNothing) {
  MotionSearch search(kMost);
  add_scans(search, test::Scene{}, 0.0, 2);
  EXPECT_FALSE(search.find().is_unambiguous);
}

// Rough ground without structure: what seems to be some is elsewhere in every scan. Of thousands of
// motions one may lay significantly more of it on each other than rest does.
TEST(MotionSearch, CellsThatAreSharedByChanceAreNotEnough) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<float> place_m(-12.0F, 12.0F), instant(0.0F, 1.0F);
  MotionSearch search(kMost);
  for (std::int64_t k = 0; k < 2; ++k) {
    std::vector<Feature> features(300);
    for (Feature& f : features) {
      f = {.x_m = place_m(rng),
           .y_m = place_m(rng),
           .s = instant(rng),
           .kind = FeatureKind::structure};
    }
    search.add({.start_ns = k * 100'000'000, .end_ns = (k + 1) * 100'000'000}, features);
  }
  const MotionSearch::Result result = search.find();
  EXPECT_FALSE(result.shares_enough);
  EXPECT_FALSE(result.is_unambiguous);
}

// Posts 1.5 m apart: 15 m/s more are one post more in each scan.
TEST(MotionSearch, SaysThatEvenlySpacedPostsAreAmbiguous) {
  test::Scene road;
  road.planes = {{{0.0, 0.0, 1.0}, -1.8}};
  for (int k = -8; k <= 8; ++k) {
    for (const double y_m : {-6.0, 6.0}) road.poles.push_back({1.5 * k, y_m, 0.2, 3.0});
  }
  MotionSearch search(kMost);
  add_scans(search, road, 7.0, 4);
  EXPECT_FALSE(search.find().is_unambiguous);
}

TEST(MotionSearch, RefinesAMotionThatIsNearlyRight) {
  MotionSearch search(kMost);
  add_scans(search, test::road_with_posts(), 15.0, 5);
  Twist about;
  about.linear_mps = {14.3, 0.4, 0.0};
  const Twist refined = search.refine(about, Subsample::all);
  EXPECT_NEAR(refined.linear_mps.x(), 15.0, 0.3);
  EXPECT_NEAR(refined.linear_mps.y(), 0.0, 0.7);  // less than a cell in five scans
}

TEST(MotionSearch, PrefersTheTrueMotionToAFalseTrackAndNotTheOtherWayRound) {
  MotionSearch search(kMost);
  add_scans(search, test::road_with_posts(), 15.0, 4);
  const auto track_at = [](double speed_mps) {
    std::array<MotionSearch::Track, 4> track;
    for (std::size_t k = 0; k < track.size(); ++k) {
      track[k].T_begin.translation_m.x() = speed_mps * 0.1 * static_cast<double>(k);
      track[k].T_end.translation_m.x() = speed_mps * 0.1 * static_cast<double>(k + 1);
    }
    return track;
  };
  Twist truth, wrong;
  truth.linear_mps.x() = 15.0;
  wrong.linear_mps.x() = 5.0;
  EXPECT_TRUE(search.is_better_than_track(truth, track_at(5.0)));
  EXPECT_FALSE(search.is_better_than_track(wrong, track_at(15.0)));
  EXPECT_FALSE(search.is_better_than_track(truth, track_at(15.0)));
}

TEST(IsSignificant, IsADifferenceBeyondWhatCountsVaryBy) {
  EXPECT_TRUE(is_significant(150.0, 100.0, 3.0));   // sigma 15.8
  EXPECT_FALSE(is_significant(140.0, 100.0, 3.0));  // sigma 15.5
  EXPECT_FALSE(is_significant(100.0, 150.0, 0.0));
}

}  // namespace
}  // namespace lilo::core
