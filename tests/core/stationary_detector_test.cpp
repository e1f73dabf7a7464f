// SPDX-License-Identifier: BSD-3-Clause
#include "core/motion/stationary_detector.hpp"

#include <gtest/gtest.h>

namespace lilo::core {
namespace {

const Eigen::Vector3d kHere = Eigen::Vector3d::Zero();

TEST(StationaryDetector, IsSupposedAfterFiveScansWithoutMotionAndUntilTheSensorIsAway) {
  StationaryDetector detector;
  const Twist slow{{0.05, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  for (int scan = 0; scan < 5; ++scan) {
    EXPECT_FALSE(detector.is_stationary());
    detector.observe(kHere, slow);
  }
  EXPECT_TRUE(detector.is_stationary());
  detector.observe({0.09, 0.0, 0.0}, slow);
  EXPECT_TRUE(detector.is_stationary());
  detector.observe({0.11, 0.0, 0.0}, slow);
  EXPECT_FALSE(detector.is_stationary());
}

TEST(StationaryDetector, AMotionInBetweenCountsAnew) {
  StationaryDetector detector;
  const Twist slow, fast{{0.2, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  for (int scan = 0; scan < 4; ++scan) detector.observe(kHere, slow);
  detector.observe(kHere, fast);
  for (int scan = 0; scan < 4; ++scan) detector.observe(kHere, slow);
  EXPECT_FALSE(detector.is_stationary());
}

}  // namespace
}  // namespace lilo::core
