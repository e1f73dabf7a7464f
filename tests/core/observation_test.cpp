// SPDX-License-Identifier: BSD-3-Clause
#include "core/tracking/observation.hpp"

#include "core/map/local_maps.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace lilo::core {
namespace {

constexpr float kNear_m = 4.9F, kFar_m = 5.1F;  // on both sides of 5 m

/// `count` features at `range_m`, in no direction that is an axis.
void add(std::vector<Feature>& features, int count, float range_m, FeatureKind kind) {
  const float each_m = range_m / std::sqrt(3.0F);
  for (int k = 0; k < count; ++k)
    features.push_back({each_m, -each_m, each_m, 0.5F, 0.0F, 0.0F, 0.1F, kind, 0});
}

TEST(Observation, HasTheScansTimesAndItsStructure) {
  Scan scan;
  scan.start_ns = 5'000'000'000;
  scan.end_ns = 5'050'000'000;
  scan.motion_compensated = true;
  scan.complete = true;
  std::vector<Feature> features;
  add(features, 70, kFar_m, FeatureKind::ground);
  add(features, 30, kFar_m, FeatureKind::structure);
  const Observation observed = observe(scan, features);
  EXPECT_EQ(observed.timing.start_ns, scan.start_ns);
  EXPECT_DOUBLE_EQ(observed.timing.span_s(), 0.05);
  EXPECT_TRUE(observed.timing.motion_compensated);
  EXPECT_TRUE(observed.is_complete);
  EXPECT_EQ(observed.structure, 30.0);
  EXPECT_EQ(observed.features, &features);
}

TEST(Observation, AHundredFeaturesSayEnough) {
  std::vector<Feature> features;
  add(features, 99, kFar_m, FeatureKind::ground);
  EXPECT_FALSE(observe({}, features).says_enough());
  add(features, 1, kFar_m, FeatureKind::structure);
  EXPECT_TRUE(observe({}, features).says_enough());
}

TEST(Observation, IsNarrowWhereMoreThanHalfOfTheStructureIsWithinFiveMetres) {
  std::vector<Feature> features;
  EXPECT_EQ(observe({}, features).levels, Levels::from_whole) << "nothing is seen";
  add(features, 50, kNear_m, FeatureKind::structure);
  add(features, 50, kFar_m, FeatureKind::structure);
  EXPECT_EQ(observe({}, features).levels, Levels::from_whole) << "a half";
  add(features, 1, kNear_m, FeatureKind::structure);
  EXPECT_EQ(observe({}, features).levels, Levels::first_known);
  add(features, 2, kFar_m, FeatureKind::structure);
  EXPECT_EQ(observe({}, features).levels, Levels::from_whole);
}

// The ground beside a vehicle is always near.
TEST(Observation, GroundDoesNotTellHowNarrowItIs) {
  std::vector<Feature> features;
  add(features, 10, kFar_m, FeatureKind::structure);
  add(features, 1000, kNear_m, FeatureKind::ground);
  EXPECT_EQ(observe({}, features).levels, Levels::from_whole);
}

}  // namespace
}  // namespace lilo::core
