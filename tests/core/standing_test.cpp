// When a sensor is supposed to stand, and when a scan may say so.
#include "core/motion/standing.hpp"

#include "core/registration/comparison.hpp"

#include <gtest/gtest.h>

namespace lilo::core {
namespace {

TEST(Standing, IsSupposedAfterFiveScansWithoutMotionAndUntilTheSensorIsAway) {
  Standing standing;
  const Twist slow{{0.05, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  for (int scan = 0; scan < 5; ++scan) {
    EXPECT_FALSE(standing.is_likely());
    standing.observe({}, slow);
  }
  EXPECT_TRUE(standing.is_likely());
  standing.observe({Eigen::Quaterniond::Identity(), {0.09, 0.0, 0.0}}, slow);
  EXPECT_TRUE(standing.is_likely());
  standing.observe({Eigen::Quaterniond::Identity(), {0.11, 0.0, 0.0}}, slow);
  EXPECT_FALSE(standing.is_likely());
}

TEST(Standing, AMotionInBetweenCountsAnew) {
  Standing standing;
  const Twist slow, fast{{0.2, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  for (int scan = 0; scan < 4; ++scan) standing.observe({}, slow);
  standing.observe({}, fast);
  for (int scan = 0; scan < 4; ++scan) standing.observe({}, slow);
  EXPECT_FALSE(standing.is_likely());
}

TEST(Standing, TheHypothesisIsThePlaceWithoutSpeedAndKeepsWhatIsKnownOfRotation) {
  Standing standing;
  const Eigen::Vector3d place_m(3.0, -2.0, 0.5);
  standing.begin({Eigen::Quaterniond::Identity(), place_m});
  Prior prior;
  prior.T_begin.translation_m = place_m + Eigen::Vector3d(0.04, 0.0, 0.0);
  prior.twist = {{0.4, 0.0, 0.0}, {0.0, 0.0, 0.2}};
  prior.begin_information *= 7.0;
  const Prior still = standing.hypothesis(prior);
  EXPECT_EQ(still.T_begin.translation_m, place_m);
  EXPECT_TRUE(still.twist.linear_mps.isZero());
  EXPECT_EQ(still.twist.angular_radps, prior.twist.angular_radps);
  EXPECT_EQ(still.begin_information(2, 2), 7.0);
  EXPECT_GT(still.begin_information(3, 3), 1.0 / (0.01 * 0.01));
}

/// An alignment that ends `x_m` ahead, whose scan tells of x `times` as much as its duration does.
Solution alignment(double x_m, double structure_inliers, double times) {
  Solution solution;
  solution.trajectory.T_begin.translation_m.x() = x_m;
  solution.trajectory.knots = Unknowns::Zero(2 * kKnotSize);
  solution.structure_inliers = structure_inliers;
  solution.motion_information = Matrix6d::Identity();
  solution.data_information = 1e4 * Matrix6d::Identity();
  solution.data_information(3, 3) = times;
  return solution;
}

TEST(Comparison, AnAlignmentFitsAsWellThatLosesLessThanATwentieth) {
  EXPECT_TRUE(fits_as_well(alignment(0.0, 96.0, 100.0), alignment(0.1, 100.0, 100.0)));
  EXPECT_FALSE(fits_as_well(alignment(0.0, 94.0, 100.0), alignment(0.1, 100.0, 100.0)));
}

TEST(Comparison, ACorridorDoesNotTellAPlaceFromAnotherAlongIt) {
  EXPECT_TRUE(tells_apart(alignment(0.0, 100.0, 50.0), alignment(0.1, 100.0, 50.0)));
  EXPECT_FALSE(tells_apart(alignment(0.0, 100.0, 5.0), alignment(0.1, 100.0, 5.0)));
}

}  // namespace
}  // namespace lilo::core
