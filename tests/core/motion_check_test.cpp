// SPDX-License-Identifier: BSD-3-Clause
#include "tests/core/motion_check_scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace lilo::core {
namespace {

using test::kSpan_s, test::kSpeed_mps, test::take, test::timing, test::Hills;

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

TEST(MotionCheck, WhereScansShareLittleNothingIsRefuted) {
  Hills hills(3);
  MotionCheck check(2000);
  for (int k = 1; k <= 100; ++k) EXPECT_FALSE(take(check, k, hills.scan())) << k;
}

}  // namespace
}  // namespace lilo::core
