// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/structure_fit.hpp"

#include <gtest/gtest.h>

namespace lilo::core {
namespace {

constexpr double kStructure = 1000.0;

Solution with_inliers(double structure_inliers, bool converged = true) {
  Solution solution;
  solution.structure_inliers = structure_inliers;
  solution.converged = converged;
  return solution;
}

StructureFit learnt(double inliers, int times = 1) {
  StructureFit fit;
  for (int k = 0; k < times; ++k) fit.learn(with_inliers(inliers), kStructure);
  return fit;
}

TEST(StructureFit, KnowsNothingAtFirst) {
  EXPECT_EQ(StructureFit{}.relative(with_inliers(0.0), kStructure), 1.0);
}

TEST(StructureFit, ComparesWithWhatFittedOfLate) {
  const StructureFit fit = learnt(800.0);
  EXPECT_NEAR(fit.relative(with_inliers(400.0), kStructure), 0.5, 1e-9);
  EXPECT_NEAR(fit.relative(with_inliers(200.0), 500.0), 0.5, 1e-9) << "half as much structure";
}

TEST(StructureFit, TakesASmallDifferenceForChance) {
  // 3 sigma of 800 are 85.
  EXPECT_EQ(learnt(800.0).relative(with_inliers(730.0), kStructure), 1.0);
  EXPECT_LT(learnt(800.0).relative(with_inliers(700.0), kStructure), 1.0);
}

TEST(StructureFit, FollowsTheSceneWithinAFewScans) {
  StructureFit fit = learnt(800.0);
  for (int k = 0; k < 10; ++k) fit.learn(with_inliers(300.0), kStructure);
  EXPECT_EQ(fit.relative(with_inliers(300.0), kStructure), 1.0);
}

// In hills now half of the structure fits, now a tenth: at a crest all that is seen is new.
TEST(StructureFit, LearnsHowMuchTheFitVaries) {
  StructureFit varied;
  for (int k = 0; k < 30; ++k) varied.learn(with_inliers(k % 2 == 0 ? 500.0 : 100.0), kStructure);
  EXPECT_EQ(varied.relative(with_inliers(10.0), kStructure), 1.0);
  for (int k = 0; k < 60; ++k) varied.learn(with_inliers(300.0), kStructure);
  EXPECT_NEAR(varied.relative(with_inliers(150.0), kStructure), 0.5, 1e-3) << "steady again";
}

// An abrupt turn begins within a scan, which fits half as well, and the next one hardly fits.
TEST(StructureFit, OneScanIsNoVariance) {
  StructureFit fit = learnt(170.0, 10);
  fit.learn(with_inliers(90.0), kStructure);
  EXPECT_LT(fit.relative(with_inliers(20.0), kStructure), 0.25);
}

TEST(StructureFit, ChanceIsNoVariance) {
  StructureFit fit = learnt(800.0);
  for (int k = 0; k < 30; ++k) fit.learn(with_inliers(k % 2 == 0 ? 780.0 : 820.0), kStructure);
  EXPECT_LT(fit.relative(with_inliers(705.0), kStructure), 1.0) << "3 sigma of 800 are 85";
}

TEST(StructureFit, LearnsNothingWhereThereIsNoStructure) {
  StructureFit fit = learnt(800.0);
  fit.learn(with_inliers(0.0), 0.0);
  EXPECT_NEAR(fit.relative(with_inliers(400.0), kStructure), 0.5, 1e-9);
}

TEST(IsExplained, AsksMoreOfWhatDidNotConverge) {
  EXPECT_TRUE(is_explained(with_inliers(0.0, true), 0.3));
  EXPECT_FALSE(is_explained(with_inliers(0.0, false), 0.3));
  EXPECT_TRUE(is_explained(with_inliers(0.0, false), 0.6));
  EXPECT_FALSE(is_explained(with_inliers(0.0, true), 0.2));
}

}  // namespace
}  // namespace lilo::core
