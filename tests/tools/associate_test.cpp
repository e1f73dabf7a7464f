// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/associate.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace lilo {
namespace {

/// Constant twist: 2 m/s along x of the world, 0.5 rad/s about z.
Pose pose_at(double t) { return {so3_exp({0, 0, 0.5 * t}), {2.0 * t, 0, 0}}; }

Trajectory trajectory(double start_s, double step_s, int count) {
  Trajectory result{.name = "made", .has_times = true};
  for (int k = 0; k < count; ++k) {
    const double t = start_s + k * step_s;
    result.poses.push_back({static_cast<std::int64_t>(t * 1e9), pose_at(t)});
  }
  return result;
}

TEST(Associate, InterpolatesTheTruthAtTheEstimatesTimes) {
  const Matched matched = associate(trajectory(0.033, 0.1, 9), trajectory(0.0, 0.1, 11));
  EXPECT_EQ(matched.unmatched, 0U);
  ASSERT_EQ(matched.truth.size(), 9U);
  for (std::size_t k = 0; k < 9; ++k) {
    const Pose D = matched.estimate[k].inverse() * matched.truth[k];
    EXPECT_LT(D.translation_m.norm(), 1e-8);
    EXPECT_LT(so3_log(D.rotation).norm(), 1e-8);
  }
}

TEST(Associate, TakesTruthAFewMillisecondsBeyondItsEndsAndNoFurther) {
  // Truth from 1 to 2 s; the estimate has poses at 0.996, 1.997 and, out of reach, 2.998 s.
  const Matched matched = associate(trajectory(0.996, 1.001, 3), trajectory(1.0, 0.1, 11));
  ASSERT_EQ(matched.truth.size(), 2U);
  EXPECT_EQ(matched.unmatched, 1U);
  EXPECT_NEAR(matched.truth[0].translation_m.x(), 2.0 * 0.996, 1e-8);
}

TEST(Associate, PairsRowsWhereOneSideKnowsNoTimes) {
  Trajectory truth = trajectory(0.0, 0.1, 5);
  truth.has_times = false;
  const Matched matched = associate(trajectory(77.0, 1.0, 5), truth);
  EXPECT_EQ(matched.truth[3].translation_m, truth.poses[3].pose.translation_m);
  truth.poses.pop_back();
  EXPECT_THROW((void)associate(trajectory(77.0, 1.0, 5), truth), std::runtime_error);
}

TEST(Associate, RefusesTrajectoriesOfDifferentDays) {
  EXPECT_THROW((void)associate(trajectory(0.0, 0.1, 5), trajectory(1000.0, 0.1, 5)),
               std::runtime_error);
}

}  // namespace
}  // namespace lilo
