// SPDX-License-Identifier: BSD-3-Clause
#include "core/search/motion_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace lilo::core {
namespace {

constexpr double kSpan_s = 0.1;
constexpr double kSpeed_mps = 2.0;

ScanTiming timing(double end_ns) {
  const auto end = static_cast<std::int64_t>(std::llround(end_ns));
  return {end - std::llround(1e9 * kSpan_s), end};
}

/// A road along a barrier that looks the same everywhere, with a truck ahead that keeps its
/// distance and, where asked for, posts.
class Road {
 public:
  explicit Road(bool has_posts) {
    for (int k = 0; k < (has_posts ? 150 : 0); ++k)
      posts_m_.emplace_back(random(-80.0, 100.0), k % 2 == 0 ? -9.0 : 12.0);
  }

  /// What the sensor sees, which is at x = speed * time.
  std::vector<Feature> scan(double end_s) {
    std::vector<Feature> features;
    const auto add = [&](const Eigen::Vector2d& p_m, bool moves) {
      const double s = random(0.0, 1.0);
      const double x_m = kSpeed_mps * (end_s - (1.0 - s) * kSpan_s);
      Feature f{};
      f.x_m = static_cast<float>(moves ? p_m.x() : p_m.x() - x_m);
      f.y_m = static_cast<float>(p_m.y());
      f.s = static_cast<float>(s);
      f.kind = FeatureKind::structure;
      features.push_back(f);
    };
    for (const Eigen::Vector2d& post : posts_m_)
      for (int k = 0; k < 3; ++k) add(post + Eigen::Vector2d(random(-0.1, 0.1), 0.0), false);
    for (int k = 0; k < 100; ++k) add({20.0, random(-1.2, 1.2)}, true);
    for (int k = 0; k < 300; ++k) add({kSpeed_mps * end_s + random(-40.0, 40.0), 5.0}, false);
    return features;
  }

 private:
  double random(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }
  std::minstd_rand random_{7};
  std::vector<Eigen::Vector2d> posts_m_;
};

/// Scans until the track, which goes at `tracked_mps`, is refuted; 100: never.
int scans_until_refuted(bool has_posts, double tracked_mps, const Eigen::Vector2d& axis) {
  Road road(has_posts);
  MotionCheck check(2000);
  for (int k = 1; k < 100; ++k) {
    const double end_s = kSpan_s * k;
    Pose begin, end;
    begin.translation_m.x() = tracked_mps * (end_s - kSpan_s);
    end.translation_m.x() = tracked_mps * end_s;
    check.add(road.scan(end_s), begin, end, timing(1e9 * end_s));
    if (check.compare(axis)) return k;
  }
  return 100;
}

TEST(MotionCheck, ATrueMotionIsNotRefuted) {
  EXPECT_EQ(scans_until_refuted(true, kSpeed_mps, {1.0, 0.0}), 100);
  EXPECT_EQ(scans_until_refuted(true, kSpeed_mps, {0.6, 0.8}), 100);
}

TEST(MotionCheck, FollowingTheTruckIsRefutedWithinASecond) {
  EXPECT_LE(scans_until_refuted(true, 0.0, {1.0, 0.0}), 10);
  EXPECT_LE(scans_until_refuted(true, 0.0, {0.0, 1.0}), 10) << "the axis may be either";
}

// The track is 21 m/s too fast on average and jumps from scan to scan, so that no constant change
// of it fits. The sign of the axis means nothing. Six scans are needed, eight test all speeds, and
// one confirms.
TEST(MotionCheck, ATrackThatIsFarTooFastIsRefutedWithinFifteenScans) {
  Road road(true);
  MotionCheck check(2000);
  Pose end;
  int refuted_at = 100;
  for (int k = 1; k < refuted_at; ++k) {
    const Pose begin = end;
    end.translation_m.x() += kSpan_s * (23.0 + 8.0 * std::sin(2.0 * k));
    check.add(road.scan(kSpan_s * k), begin, end, timing(1e9 * kSpan_s * k));
    if (check.compare({k % 2 == 0 ? 1.0 : -1.0, 0.0})) refuted_at = k;
  }
  EXPECT_LE(refuted_at, 15);
}

// Two rails that look the same everywhere, in fog: 20 m of them are seen to either side, wherever
// the sensor is. At rest they would share the most cells.
TEST(MotionCheck, RailsInFogRefuteNoMotion) {
  constexpr double kTracked_mps = 40.0;
  std::minstd_rand random(3);
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  MotionCheck check(2000);
  for (int k = 1; k < 60; ++k) {
    std::vector<Feature> features;
    for (int n = 0; n < 1200; ++n) {
      Feature f{};
      f.x_m = static_cast<float>(uniform(-20.0, 20.0));
      f.y_m = n % 2 == 0 ? -5.0F : 5.0F;
      f.s = static_cast<float>(uniform(0.0, 1.0));
      f.kind = FeatureKind::structure;
      features.push_back(f);
    }
    Pose begin, end;
    begin.translation_m.x() = kTracked_mps * kSpan_s * (k - 1);
    end.translation_m.x() = kTracked_mps * kSpan_s * k;
    check.add(features, begin, end, timing(1e9 * kSpan_s * k));
    EXPECT_FALSE(check.compare({1.0, 0.0})) << "after " << k << " scans";
  }
}

TEST(MotionCheck, WhereNothingTellsNothingIsRefuted) {
  EXPECT_EQ(scans_until_refuted(false, 0.0, {1.0, 0.0}), 100);
}

// Scans that have nothing in common, as of a sensor that looks elsewhere each time.
TEST(MotionCheck, WhereScansDoNotMeetNothingIsRefuted) {
  std::minstd_rand random(3);
  std::uniform_real_distribution<float> anywhere_m(-100.0F, 100.0F);
  MotionCheck check(2000);
  for (int k = 1; k < 100; ++k) {
    std::vector<Feature> features(200);
    for (Feature& f : features) {
      f.x_m = anywhere_m(random);
      f.y_m = anywhere_m(random);
      f.kind = FeatureKind::structure;
    }
    check.add(features, {}, {}, timing(1e9 * kSpan_s * k));
    EXPECT_FALSE(check.compare({1.0, 0.0}));
  }
}

TEST(MotionCheck, AfterAClearItBeginsAgain) {
  Road road(true);
  MotionCheck check(2000);
  for (int k = 1; k < 50; ++k) {
    if (k % 5 == 0) check.clear();
    check.add(road.scan(kSpan_s * k), {}, {}, timing(1e9 * kSpan_s * k));
    EXPECT_FALSE(check.compare({1.0, 0.0})) << "five scans are too few";
  }
}

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

/// Takes the scan number `k`, tracked along x. Returns whether the motion is refuted.
bool take(MotionCheck& check, int k, const std::vector<Feature>& features,
          double tracked_mps = kSpeed_mps, bool is_dead_reckoned = false) {
  Pose begin, end;
  begin.translation_m.x() = tracked_mps * kSpan_s * (k - 1);
  end.translation_m.x() = tracked_mps * kSpan_s * k;
  check.add(features, begin, end, timing(1e9 * kSpan_s * k));
  const bool is_refuted = check.compare({1.0, 0.0});
  check.observe_ambiguity({1.0, 0.0}, is_dead_reckoned);
  return is_refuted;
}

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

TEST(MotionCheck, BetweenTwoLanesTheMotionIsAmbiguousWhicheverIsTracked) {
  constexpr double kCars_mps = 1.0;
  const Lanes lanes(120, 120, kCars_mps, 0.05);
  EXPECT_GT(ambiguous_scans(lanes, kSpeed_mps), 60);
  EXPECT_GT(ambiguous_scans(lanes, kSpeed_mps - kCars_mps), 60);
}

TEST(MotionCheck, WhereEverythingIsFixedTheMotionIsNotAmbiguous) {
  EXPECT_EQ(ambiguous_scans({150, 0, 0.0, 0.05}, kSpeed_mps), 0);
  EXPECT_EQ(ambiguous_scans({150, 0, 0.0, 0.4}, kSpeed_mps), 0) << "tracked roughly";
  EXPECT_EQ(ambiguous_scans({8, 0, 0.0, 0.05}, kSpeed_mps), 0) << "a field with few posts";
}

TEST(MotionCheck, ScansWithoutStructureDoNotEndTheSearchForAmbiguity) {
  MotionCheck check(2000);
  for (int k = 1; k <= 40; ++k) take(check, k, {});
  EXPECT_FALSE(check.is_ambiguous());
  Lanes lanes(120, 120, 1.0, 0.05);
  bool was_ambiguous = false;
  for (int k = 41; k <= 100; ++k) {
    take(check, k, lanes.scan(kSpan_s * k));
    was_ambiguous |= check.is_ambiguous();
  }
  EXPECT_TRUE(was_ambiguous);
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

// Two scans of a room with a second of bare ground between them lie on each other under other
// motions as well, by chance.
TEST(MotionCheck, ScansBeforeBareGroundAreNotComparedWithThoseAfterIt) {
  std::minstd_rand random(3);
  for (int bare_scans = 1; bare_scans <= 15; ++bare_scans) {
    MotionCheck check(2000);
    for (int k = 1; k <= 80; ++k) {
      const bool is_bare = k > 30 && k <= 30 + bare_scans;
      take(check, k, is_bare ? std::vector<Feature>() : room_scan(random), 0.0);
      EXPECT_FALSE(check.is_ambiguous()) << "scan " << k << ", " << bare_scans << " of bare ground";
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

TEST(MotionCheck, WhatWasAmbiguousInATunnelEndsNoSession) {
  EXPECT_TRUE(ambiguity_ends(0));
  EXPECT_TRUE(ambiguity_ends(3)) << "weak at times, as between trucks";
  EXPECT_FALSE(ambiguity_ends(1));
}

// What was tracked meanwhile is as doubtful where the sensor was lost as where one motion won.
TEST(MotionCheck, ALostScanEndsTheAmbiguityOnce) {
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

/// Bare hills: each scan sees other steep ground, in lines across the way as rings meet it. So many
/// of twelve lines lie at the same range in every scan.
class Hills {
 public:
  explicit Hills(int at_same_range) : at_same_range_(at_same_range) {}

  std::vector<Feature> scan() {
    std::vector<Feature> features;
    for (int line = 0; line < 12; ++line) {
      Feature f{};
      f.kind = FeatureKind::structure;
      const bool is_same = line < at_same_range_;
      f.x_m = is_same ? 5.0F + 4.0F * static_cast<float>(line) : anywhere_m_(random_);
      f.y_m = is_same ? -5.0F : anywhere_m_(random_);
      for (int point = 0; point < 20; ++point, f.y_m += 0.5F) features.push_back(f);
    }
    return features;
  }

 private:
  int at_same_range_;
  std::minstd_rand random_{5};
  std::uniform_real_distribution<float> anywhere_m_{-40.0F, 40.0F};
};

// Some lines of two scans come to lie on each other under some motion.
TEST(MotionCheck, WhereScansShareLittleTheMotionIsNotAmbiguous) {
  Hills hills(0);
  MotionCheck check(2000);
  for (int k = 1; k <= 300; ++k) {
    take(check, k, hills.scan());
    EXPECT_FALSE(check.is_ambiguous()) << k;
  }
}

TEST(MotionCheck, WhereScansShareLittleNothingIsRefuted) {
  Hills hills(3);
  MotionCheck check(2000);
  for (int k = 1; k <= 100; ++k) EXPECT_FALSE(take(check, k, hills.scan())) << k;
}

TEST(MotionCheck, AFewCarsDoNotMakeItAmbiguous) {
  EXPECT_EQ(ambiguous_scans({150, 8, 1.0, 0.05}, kSpeed_mps), 0);
}

}  // namespace
}  // namespace lilo::core
