// SPDX-License-Identifier: BSD-3-Clause
#include "core/search/displacement_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace lilo::core {
namespace {

constexpr double kSpan_s = 0.1;
const Eigen::Vector3d kCenter_m(300.0, -120.0, 4.0);  // the map's, far from the origin

std::vector<Eigen::Vector3d> posts_around(const Eigen::Vector3d& center_m, std::size_t count) {
  std::minstd_rand random(5);
  std::uniform_real_distribution<double> across(-50.0, 50.0), high(-1.0, 3.0);
  std::vector<Eigen::Vector3d> posts_m(count);
  for (Eigen::Vector3d& post_m : posts_m) {
    post_m = center_m + Eigen::Vector3d(across(random), across(random), high(random));
  }
  return posts_m;
}

CellMap map_of(const std::vector<Eigen::Vector3d>& points_m) {
  CellMap map({.cell_m = 1.5F});
  for (const Eigen::Vector3d& p_m : points_m) map.insert(p_m, Eigen::Vector3f::Zero());
  return map;
}

Trajectory trajectory_to(const Pose& T_end, double speed_mps) {
  Trajectory way;
  way.span_s = kSpan_s;
  way.twist.linear_mps.x() = speed_mps;
  way.T_begin = moved(T_end, way.twist, -kSpan_s);
  way.knots = Unknowns::Zero(Eigen::Index{kKnotSize} * (way.segments + 1));
  return way;
}

/// What a sensor on that way sees of the points, evenly over its turn.
std::vector<Feature> seen_from(const Trajectory& way,
                               const std::vector<Eigen::Vector3d>& points_m) {
  std::vector<Feature> features;
  for (std::size_t k = 0; k < points_m.size(); ++k) {
    Feature f{};
    f.s = static_cast<float>(k) / static_cast<float>(points_m.size());
    const Eigen::Vector3d p = way.at(static_cast<double>(f.s)).inverse() * points_m[k];
    f.x_m = static_cast<float>(p.x());
    f.y_m = static_cast<float>(p.y());
    f.z_m = static_cast<float>(p.z());
    f.kind = FeatureKind::structure;
    features.push_back(f);
  }
  return features;
}

Pose pose_at(double x_m, double y_m, double yaw_rad) {
  return {so3_exp({0.0, 0.0, yaw_rad}), kCenter_m + Eigen::Vector3d(x_m, y_m, 0.0)};
}

/// How far the first place found is from the true one: m, and rad.
std::pair<double, double> error_of_best(double speed_mps, const Displacement& true_by) {
  const auto posts_m = posts_around(kCenter_m, 200);
  DisplacementSearch search(1000);
  search.set_map(map_of(posts_m), kCenter_m);
  const Trajectory predicted = trajectory_to(pose_at(2.0, -1.0, 0.3), speed_mps);
  const Trajectory truth = trajectory_to(displaced(predicted.end(), true_by), speed_mps);
  const auto places =
      search.find(seen_from(truth, posts_m), predicted, DisplacementSearch::kFarthest);
  if (places.empty()) return {1e9, 1e9};
  return {(places[0].along_m - true_by.along_m).norm(),
          std::abs(places[0].yaw_rad - true_by.yaw_rad)};
}

TEST(DisplacementSearch, FindsWhereAScanWasTakenToAStep) {
  for (const double speed_mps : {0.0, 20.0}) {
    for (const Displacement& by :
         {Displacement{}, Displacement{{3.3, -2.1}, 0.4}, Displacement{{-9.0, 7.4}, -0.73},
          Displacement{{0.4, 11.0}, 0.1}, Displacement{{-3.0, 1.2}, 2.9},
          Displacement{{5.2, 4.4}, -1.9}}) {
      const auto [along_m, yaw_rad] = error_of_best(speed_mps, by);
      EXPECT_LT(along_m, 1.0) << by.along_m.transpose() << " at " << speed_mps << " m/s";
      EXPECT_LT(yaw_rad, 0.05) << by.yaw_rad << " at " << speed_mps << " m/s";
    }
  }
}

// A sensor that stood begins to spin; and one whose last pose was wrong already.
TEST(DisplacementSearch, FindsATurnBegunDuringTheScan) {
  const auto posts_m = posts_around(kCenter_m, 200);
  DisplacementSearch search(1000);
  search.set_map(map_of(posts_m), kCenter_m);
  const Trajectory predicted = trajectory_to(pose_at(0.0, 0.0, 0.3), 0.0);
  for (const auto& [begin_rad, end_rad] :
       {std::pair(0.0, 0.6), std::pair(0.0, -0.35), std::pair(0.2, 0.75), std::pair(-0.3, 0.1)}) {
    Trajectory truth = predicted;
    truth.T_begin = displaced(predicted.T_begin, {{0.0, 0.0}, begin_rad});
    truth.twist.angular_radps.z() = (end_rad - begin_rad) / kSpan_s;
    const SearchRadius radius{0.0, 0.8, std::abs(begin_rad) > 0.0 ? 0.4 : 0.0};
    const auto places =
        search.find(seen_from(truth, posts_m), predicted, radius, Onset::within_scan);
    ASSERT_FALSE(places.empty());
    EXPECT_NEAR(places[0].yaw_rad, end_rad, 0.06);
    EXPECT_NEAR(places[0].begin_yaw_rad, begin_rad, 0.11);
    // Nothing moves a sensor a metre within the scan in which it begins to turn.
    for (const Displacement& place : places) EXPECT_TRUE(place.along_m.isZero(0.0));
  }
}

TEST(DisplacementSearch, StaysWithinTheRadius) {
  const auto posts_m = posts_around(kCenter_m, 200);
  DisplacementSearch search(1000);
  search.set_map(map_of(posts_m), kCenter_m);
  const Trajectory predicted = trajectory_to(pose_at(0.0, 0.0, 0.0), 0.0);
  const Trajectory truth = trajectory_to(pose_at(8.0, 0.0, 0.0), 0.0);
  // A wide step, and one around it.
  constexpr double kMore_m = 3.0 * std::numbers::sqrt2, kMore_rad = 0.15;
  for (const Displacement& by : search.find(seen_from(truth, posts_m), predicted, {2.0, 0.1})) {
    EXPECT_LT(by.along_m.norm(), 2.0 + kMore_m);
    EXPECT_LT(std::abs(by.yaw_rad), 0.1 + kMore_rad);
  }
}

// A fence whose posts stand five metres apart: one that is a post farther along is nearly as good.
TEST(DisplacementSearch, OffersEveryPlaceThatLooksAlike) {
  constexpr double kApart_m = 5.0;
  std::vector<Eigen::Vector3d> fence_m;
  for (int k = -20; k <= 20; ++k) {
    fence_m.push_back(kCenter_m + Eigen::Vector3d(kApart_m * k, 6.0, 0.0));
  }
  DisplacementSearch search(1000);
  search.set_map(map_of(fence_m), kCenter_m);
  const Trajectory predicted = trajectory_to(pose_at(0.0, 0.0, 0.0), 0.0);
  const auto places =
      search.find(seen_from(predicted, fence_m), predicted, DisplacementSearch::kFarthest);
  ASSERT_EQ(places.size(), search::kMostPlaces);
  for (std::size_t k = 0; k < places.size(); ++k) {
    EXPECT_LT(std::abs(places[k].along_m.y()), 1.5);
    EXPECT_NEAR(std::remainder(places[k].along_m.x(), kApart_m), 0.0, 1.0);
    for (std::size_t other = 0; other < k; ++other) {
      EXPECT_GT((places[k].along_m - places[other].along_m).norm(), kApart_m - 2.0);
    }
  }
}

TEST(DisplacementSearch, KnowsOnlyTheMapItWasGivenLast) {
  const auto posts_m = posts_around(kCenter_m, 200);
  std::vector<Eigen::Vector3d> moved_m = posts_m;
  for (Eigen::Vector3d& p_m : moved_m) p_m.x() += 6.0;
  DisplacementSearch search(1000);
  search.set_map(map_of(posts_m), kCenter_m);
  search.set_map(map_of(moved_m), kCenter_m);
  const Trajectory predicted = trajectory_to(pose_at(0.0, 0.0, 0.0), 0.0);
  const auto places =
      search.find(seen_from(predicted, posts_m), predicted, DisplacementSearch::kFarthest);
  ASSERT_FALSE(places.empty());
  EXPECT_LT((places[0].along_m - Eigen::Vector2d(6.0, 0.0)).norm(), 1.0);
}

}  // namespace
}  // namespace lilo::core
