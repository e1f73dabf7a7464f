// SPDX-License-Identifier: BSD-3-Clause
// Whether two motions fit, against scenes that move in known ways.
#include "tests/core/motion_check_scenes.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace lilo::core {
namespace {

using test::kSpan_s, test::kSpeed_mps, test::take, test::Hills;

/// Posts beside the road, and two lanes of cars between them that drive alike, as a sensor sees
/// them that drives at kSpeed_mps. Each point is off by up to `rough_m`.
class Lanes {
 public:
  Lanes(int posts, int cars, double cars_mps, double rough_m)
      : cars_mps_(cars_mps), rough_m_(rough_m) {
    for (int k = 0; k < posts; ++k)
      posts_m_.emplace_back(random(-40.0, 60.0), k % 2 == 0 ? -9.0 : 9.0);
    for (int k = 0; k < cars; ++k)
      cars_m_.emplace_back(random(-40.0, 60.0), k % 2 == 0 ? -3.5 : 3.5);
  }

  std::vector<Feature> scan(double end_s) {
    std::vector<Feature> features;
    const auto add = [&](const Eigen::Vector2d& p_m, double mps) {
      for (int k = 0; k < 3; ++k) {
        const double s = random(0.0, 1.0), at_s = end_s - (1.0 - s) * kSpan_s;
        Feature f{};
        f.x_m =
            static_cast<float>(p_m.x() + (mps - kSpeed_mps) * at_s + random(-rough_m_, rough_m_));
        f.y_m = static_cast<float>(p_m.y() + random(-rough_m_, rough_m_));
        f.s = static_cast<float>(s);
        f.kind = FeatureKind::structure;
        features.push_back(f);
      }
    };
    for (const Eigen::Vector2d& post : posts_m_) add(post, 0.0);
    for (const Eigen::Vector2d& car : cars_m_) add(car, cars_mps_);
    return features;
  }

 private:
  double random(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }
  std::minstd_rand random_{11};
  std::vector<Eigen::Vector2d> posts_m_, cars_m_;
  double cars_mps_, rough_m_;
};

/// Scans of 100 after which the motion is ambiguous.
int ambiguous_scans(Lanes lanes, double tracked_mps) {
  MotionCheck check(2000);
  int ambiguous = 0;
  for (int k = 1; k <= 100; ++k) {
    take(check, k, lanes.scan(kSpan_s * k), tracked_mps);
    if (check.is_ambiguous()) ++ambiguous;
  }
  return ambiguous;
}

TEST(MotionAmbiguity, BetweenTwoLanesTheMotionIsAmbiguousWhicheverIsTracked) {
  constexpr double kCars_mps = 1.0;
  const Lanes lanes(120, 120, kCars_mps, 0.05);
  EXPECT_GT(ambiguous_scans(lanes, kSpeed_mps), 60);
  EXPECT_GT(ambiguous_scans(lanes, kSpeed_mps - kCars_mps), 60);
}

TEST(MotionAmbiguity, WhereEverythingIsFixedTheMotionIsNotAmbiguous) {
  EXPECT_EQ(ambiguous_scans({150, 0, 0.0, 0.05}, kSpeed_mps), 0);
  EXPECT_EQ(ambiguous_scans({150, 0, 0.0, 0.4}, kSpeed_mps), 0) << "tracked roughly";
  EXPECT_EQ(ambiguous_scans({40, 0, 0.0, 0.05}, kSpeed_mps), 0) << "a field with few posts";
}

TEST(MotionAmbiguity, OnBareGroundItEndsAndIsFoundAgainAfterwards) {
  MotionCheck check(2000);
  Lanes lanes(120, 120, 1.0, 0.05);
  const auto drive = [&](int first, int last, bool is_bare) {
    for (int k = first; k <= last; ++k) {
      take(check, k, is_bare ? std::vector<Feature>() : lanes.scan(kSpan_s * k));
    }
  };
  drive(1, 60, false);
  ASSERT_TRUE(check.is_ambiguous());
  drive(61, 70, true);
  EXPECT_FALSE(check.is_ambiguous());
  drive(71, 130, false);
  EXPECT_TRUE(check.is_ambiguous());
}

/// The walls of a room of 24 x 14 m, seen from its middle.
std::vector<Feature> room_scan(std::minstd_rand& random) {
  std::uniform_real_distribution<double> along(-1.0, 1.0), off_m(-0.02, 0.02);
  std::vector<Feature> features;
  for (int k = 0; k < 1000; ++k) {
    const double x = along(random);
    const double side = k % 4 < 2 ? 1.0 : -1.0;
    Feature f{};
    f.x_m = static_cast<float>(k % 2 == 0 ? 12.0 * x : side * 12.0 + off_m(random));
    f.y_m = static_cast<float>(k % 2 == 0 ? side * 7.0 + off_m(random) : 7.0 * x);
    f.s = static_cast<float>(0.5 + 0.5 * along(random));
    f.kind = FeatureKind::structure;
    features.push_back(f);
  }
  return features;
}

// Scans of a room with bare ground between them lie on each other under other motions as well, by
// chance. And without structure in the newest one nothing keeps the others where they are.
TEST(MotionAmbiguity, ScansBeforeBareGroundAreNotComparedWithThoseAfterIt) {
  std::minstd_rand random(3);
  for (int bare_scans = 1; bare_scans <= 15; ++bare_scans) {
    MotionCheck check(2000);
    for (int k = 1; k <= 80; ++k) {
      const bool is_bare = k > 30 && k <= 30 + bare_scans;
      EXPECT_FALSE(take(check, k, is_bare ? std::vector<Feature>() : room_scan(random), 0.0))
          << "scan " << k << ", " << bare_scans << " of bare ground";
      EXPECT_FALSE(check.is_ambiguous()) << "scan " << k << ", " << bare_scans;
    }
  }
}

/// Whether it ends when the lanes beside the sensor turn off, and one of so many scans has a weak
/// direction; 0: none.
bool ambiguity_ends(int weak_stride) {
  MotionCheck check(2000);
  Lanes moving(120, 120, 1.0, 0.05), fixed(150, 0, 0.0, 0.05);
  bool has_ended = false;
  for (int k = 1; k <= 100; ++k) {
    take(check, k, (k <= 60 ? moving : fixed).scan(kSpan_s * k), kSpeed_mps,
         weak_stride > 0 && k % weak_stride == 0);
    has_ended |= check.ambiguity_ended();
  }
  return has_ended;
}

TEST(MotionAmbiguity, WhatWasAmbiguousInATunnelEndsNoSession) {
  EXPECT_TRUE(ambiguity_ends(0));
  EXPECT_TRUE(ambiguity_ends(3)) << "weak at times, as between trucks";
  EXPECT_FALSE(ambiguity_ends(1));
}

// What was tracked meanwhile is as doubtful where the sensor was lost as where one motion won.
TEST(MotionAmbiguity, ALostScanEndsTheAmbiguityOnce) {
  Lanes lanes(120, 120, 1.0, 0.05);
  MotionCheck check(2000);
  int in_a_row = 0;
  for (int k = 1; k <= 100 && in_a_row < 12; ++k) {
    take(check, k, lanes.scan(kSpan_s * k));
    in_a_row = check.is_ambiguous() ? in_a_row + 1 : 0;
  }
  ASSERT_EQ(in_a_row, 12);
  EXPECT_FALSE(check.ambiguity_ended());
  check.clear();
  EXPECT_TRUE(check.ambiguity_ended());
  EXPECT_FALSE(check.is_ambiguous());
  check.clear();
  EXPECT_FALSE(check.ambiguity_ended());
}

// Some lines of two scans come to lie on each other under some motion.
TEST(MotionAmbiguity, WhereScansShareLittleTheMotionIsNotAmbiguous) {
  Hills hills(0);
  MotionCheck check(2000);
  for (int k = 1; k <= 300; ++k) {
    take(check, k, hills.scan());
    EXPECT_FALSE(check.is_ambiguous()) << k;
  }
}

TEST(MotionAmbiguity, AFewCarsDoNotMakeItAmbiguous) {
  EXPECT_EQ(ambiguous_scans({150, 8, 1.0, 0.05}, kSpeed_mps), 0);
}

}  // namespace
}  // namespace lilo::core
