// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/metrics.hpp"

#include "tools/eval/report.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>

namespace lilo {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// Circle of `radius_m` driven once in `count` equal steps, heading along the tangent.
std::vector<Pose> circle(double radius_m, int count) {
  std::vector<Pose> poses;
  for (int k = 0; k <= count; ++k) {
    const double a = 2.0 * std::numbers::pi * k / count;
    poses.push_back(
        {so3_exp({0, 0, a}), {radius_m * std::sin(a), radius_m * (1.0 - std::cos(a)), 0}});
  }
  return poses;
}

/// Straight road along x, `step_m` a pose; the estimate yaws by `yaw_rad` more at each pose.
Matched straight(int count, double step_m, double yaw_rad) {
  Matched poses;
  for (int k = 0; k < count; ++k) {
    poses.truth.push_back({.translation_m = {k * step_m, 0, 0}});
    poses.estimate.push_back({so3_exp({0, 0, yaw_rad * k}), {k * step_m, 0, 0}});
  }
  return poses;
}

TEST(Segments, PerfectEstimateHasNoErrorInAnyFrame) {
  const Pose frame{so3_exp({0.3, -1.0, 2.0}), {100, -50, 7}};
  Matched poses{.truth = circle(100.0, 1000)};
  for (const Pose& pose : poses.truth) poses.estimate.push_back(frame * pose);
  const SegmentErrors errors = segment_errors(poses, {100.0, 200.0}, 10);
  ASSERT_TRUE(errors.overall);
  EXPECT_NEAR(errors.overall->t_percent, 0.0, 1e-9);
  EXPECT_NEAR(errors.overall->r_deg_per_100m, 0.0, 1e-9);
  EXPECT_NEAR(absolute_error_m(poses).max, 0.0, 1e-9);
  EXPECT_NEAR(relative_error(poses).translation_m.max, 0.0, 1e-9);
  EXPECT_NEAR(closure(poses).error_m, 0.0, 1e-9);
}

TEST(Segments, ScaleErrorOnAStraightRoadIsThatManyPercent) {
  Matched poses;
  for (int k = 0; k <= 1000; ++k) {
    poses.truth.push_back({.translation_m = {k * 1.0, 0, 0}});
    poses.estimate.push_back({.translation_m = {k * 1.02, 0, 0}});
  }
  // A segment ends at the first pose more than L beyond its start: L + 1 m here.
  const SegmentErrors errors = segment_errors(poses, {100.0, 400.0}, 10);
  ASSERT_EQ(errors.per_length.size(), 2U);
  EXPECT_NEAR(errors.per_length[0].t_percent, 2.0 * 101.0 / 100.0, 1e-9);
  EXPECT_NEAR(errors.per_length[1].t_percent, 2.0 * 401.0 / 400.0, 1e-9);
  EXPECT_NEAR(errors.overall->r_deg_per_100m, 0.0, 1e-9);
  // Starts 0, 10, ... with the end still on the road: 899 / 10 and 599 / 10 rounded down, plus one.
  EXPECT_EQ(errors.per_length[0].count, 90);
  EXPECT_EQ(errors.per_length[1].count, 60);
  EXPECT_EQ(errors.overall->count, 150);
  EXPECT_NEAR(errors.overall->t_percent, (90 * 2.02 + 60 * 2.005) / 150, 1e-9);
}

TEST(Segments, ScaleErrorOnACircleIsTheChordsScaleError) {
  constexpr double kRadius = 100.0, kScale = 0.99;
  constexpr int kCount = 10000;
  Matched poses{.estimate = circle(kRadius * kScale, kCount), .truth = circle(kRadius, kCount)};
  const SegmentErrors errors = segment_errors(poses, {150.0}, 10);
  const double chord = 2.0 * kRadius * std::sin(150.0 / kRadius / 2.0);
  EXPECT_NEAR(errors.overall->t_percent, (1.0 - kScale) * chord / 150.0 * 100.0, 1e-3);
  EXPECT_NEAR(errors.overall->r_deg_per_100m, 0.0, 1e-9);
}

TEST(Segments, ConstantYawDriftIsDegreesPerMetre) {
  // 0.01 deg a pose, two poses a metre: 2 deg per 100 m.
  const Matched poses = straight(2001, 0.5, 0.01 * kDegree);
  const SegmentErrors errors = segment_errors(poses, {100.0}, 1);
  // The segment is 100.5 m long, 201 poses.
  EXPECT_NEAR(errors.overall->r_deg_per_100m, 2.01, 1e-9);
}

TEST(Segments, NoneOnAPathShorterThanEveryLength) {
  const Matched poses = straight(10, 1.0, 0.0);
  const SegmentErrors errors = segment_errors(poses, {100.0}, 10);
  EXPECT_FALSE(errors.overall);
  EXPECT_TRUE(errors.per_length.empty());
}

TEST(Segments, DefaultLengthsFitThePath) {
  EXPECT_EQ(default_lengths_m(1000.0).size(), 8U);
  EXPECT_EQ(default_lengths_m(1000.0).back(), 800.0);
  EXPECT_EQ(default_lengths_m(206.0), (std::vector<double>{100, 200}));
  EXPECT_EQ(default_lengths_m(35.0), (std::vector<double>{10, 20, 30}));
  EXPECT_EQ(default_lengths_m(2.5), (std::vector<double>{1, 2}));
  EXPECT_TRUE(default_lengths_m(0.5).empty());
}

TEST(AbsoluteError, IsTheRadiusDifferenceOfConcentricCircles) {
  const Pose frame{so3_exp({1.0, 0.2, -0.4}), {5, 6, 7}};
  Matched poses{.truth = circle(10.0, 360)};
  for (const Pose& pose : circle(10.5, 360)) poses.estimate.push_back(frame * pose);
  // Start and end coincide, which moves the centroid a little off the centre.
  EXPECT_NEAR(absolute_error_m(poses).rmse, 0.5, 1e-3);
}

TEST(AbsoluteError, IsZeroForARigidOffsetEvenOnAStraightLine) {
  Matched poses = straight(50, 1.0, 0.0);
  for (Pose& pose : poses.estimate) pose = Pose{so3_exp({0, 0, 1}), {1, 2, 3}} * pose;
  EXPECT_NEAR(absolute_error_m(poses).max, 0.0, 1e-9);
}

TEST(AbsoluteError, IsZeroAtStandstill) {
  Matched poses{.estimate = std::vector<Pose>(5), .truth = std::vector<Pose>(5)};
  EXPECT_EQ(absolute_error_m(poses).rmse, 0.0);
}

TEST(RelativeError, IsTheStepsError) {
  Matched poses = straight(11, 1.0, 0.5 * kDegree);
  const RelativeError error = relative_error(poses);
  EXPECT_NEAR(error.rotation_deg.rmse, 0.5, 1e-9);
  EXPECT_NEAR(error.rotation_deg.max, 0.5, 1e-9);
  // The step seen from pose k is turned by k times 0.5 deg: a chord of that angle; the largest is
  // the last one's, 9 steps in, seen after its own turn.
  EXPECT_NEAR(error.translation_m.max, 2.0 * std::sin(9 * 0.5 * kDegree / 2.0), 1e-9);
}

TEST(Closure, OfALoopIsTheGapThatRemains) {
  Matched poses{.estimate = circle(50.0, 500), .truth = circle(50.0, 500)};
  poses.estimate.back().translation_m += Eigen::Vector3d(0.3, 0.0, 0.4);
  const Closure gap = closure(poses);
  EXPECT_NEAR(gap.truth_m, 0.0, 1e-9);
  EXPECT_NEAR(gap.estimate_m, 0.5, 1e-9);
  EXPECT_NEAR(gap.error_m, 0.5, 1e-9);
  EXPECT_NEAR(gap.error_deg, 0.0, 1e-9);
}

TEST(Report, JsonHoldsTheFiguresAndNullWhereNoSegmentFits) {
  Trajectory truth{.name = "truth", .has_times = true};
  for (int k = 0; k < 5; ++k) truth.poses.push_back({k, {.translation_m = {k * 1.0, 0, 0}}});
  const auto json = nlohmann::json::parse(to_json(evaluate(truth, truth, {100.0}, 10)));
  EXPECT_TRUE(json["t_percent"].is_null());
  EXPECT_EQ(json["segments"], 0);
  EXPECT_EQ(json["poses"], 5);
  EXPECT_EQ(json["truth_path_m"], 4.0);
  const auto fits = nlohmann::json::parse(to_json(evaluate(truth, truth, {}, 1)));
  EXPECT_EQ(fits["t_percent"], 0.0);
  EXPECT_EQ(fits["per_length"].size(), 3U);  // 1, 2, 3 m
}

}  // namespace
}  // namespace lilo
