// SPDX-License-Identifier: BSD-3-Clause
#include "core/tracking/keyframe_map.hpp"

#include "tests/core/observed_scan.hpp"

#include <gtest/gtest.h>

namespace lilo::core {
namespace {

constexpr int kEnough = 6;  // keyframes after which the map is no longer filled at once
constexpr double kApart_m = 0.85;
constexpr double kFilled_m = kApart_m * (kEnough - 1);  // place of the last one of them

Solution solution_at(const Pose& T_begin, int matched = 1000) {
  Solution solution;
  solution.trajectory.T_begin = T_begin;
  solution.trajectory.knots = Unknowns::Zero(Eigen::Index{kKnotSize} * 2);
  solution.looked_up = 1000;
  solution.matched = matched;
  return solution;
}

class KeyframeMapTest : public testing::Test {
 protected:
  /// The yard from `x_m`, as the scan after the last one.
  bool grow(double x_m, MapUse use = MapUse::keyframe, int matched = 1000, bool is_room = false) {
    Pose T{Eigen::Quaterniond::Identity(), {x_m, 0.0, 0.0}};
    const std::uint64_t index = count_++;
    const test::ObservedScan scan(
        test::yard(), [&](double) { return T; }, index);
    return map_.grow({scan.timing(), scan.features(), solution_at(T, matched), T, use,
                      LocalMaps::kWhole, is_room});
  }
  void fill() {
    for (int k = 0; k < kEnough; ++k) grow(kApart_m * k);
  }

  KeyframeMap map_{DefaultConfig{}};
  std::uint64_t count_ = 0;
};

TEST_F(KeyframeMapTest, TakesTheFirstScan) {
  EXPECT_TRUE(grow(0.0));
  EXPECT_EQ(map_.keyframes(), 1);
  EXPECT_GT(map_.cells().size(), 100);
}

TEST_F(KeyframeMapTest, GrowsWhenTheSensorHasMoved) {
  fill();
  const int before = map_.keyframes();
  EXPECT_FALSE(grow(kFilled_m + 0.35));
  EXPECT_FALSE(grow(kFilled_m + 0.75));
  EXPECT_TRUE(grow(kFilled_m + 0.85));
  EXPECT_EQ(map_.keyframes(), before + 1);
}

TEST_F(KeyframeMapTest, GrowsSoonerInRooms) {
  fill();
  EXPECT_FALSE(grow(kFilled_m + 0.25, MapUse::keyframe, 1000, true));
  EXPECT_FALSE(grow(kFilled_m + 0.35, MapUse::keyframe, 1000, false));
  EXPECT_TRUE(grow(kFilled_m + 0.35, MapUse::keyframe, 1000, true));
}

TEST_F(KeyframeMapTest, GrowsSoonerWhileItIsYoung) {
  EXPECT_TRUE(grow(0.0));
  for (int k = 1; k < 5; ++k) {
    EXPECT_FALSE(grow(0.35 * k - 0.1)) << k;
    EXPECT_TRUE(grow(0.35 * k)) << k;
  }
  EXPECT_FALSE(grow(0.35 * 5));
}

TEST_F(KeyframeMapTest, OfAStandingSensorGrowsWhileItKnowsTooLittle) {
  grow(0.0);
  EXPECT_TRUE(grow(0.0, MapUse::keyframe, 300));
  EXPECT_FALSE(grow(0.0, MapUse::keyframe, 900));
}

TEST_F(KeyframeMapTest, LeavesOutWhatWasNotAligned) {
  fill();
  EXPECT_FALSE(grow(9.0, MapUse::none));
  EXPECT_FALSE(grow(9.0, MapUse::end_only));
  EXPECT_TRUE(grow(9.0));
}

TEST_F(KeyframeMapTest, EntersOneScanLate) {
  fill();
  grow(3.0, MapUse::none);  // whatever was held is in
  const int before = map_.cells().size();
  const std::uint64_t revision = map_.revision();
  ASSERT_TRUE(grow(9.0));
  EXPECT_EQ(map_.cells().size(), before);
  EXPECT_EQ(map_.revision(), revision);
  grow(9.0);
  EXPECT_GT(map_.cells().size(), before);
  EXPECT_GT(map_.revision(), revision);
}

// The next scan begins 0.4 m beside where the keyframe was thought to end.
TEST_F(KeyframeMapTest, TheNextScanPutsTheEndOfAKeyframeRight) {
  const auto mean_y_m = [](MapUse use, bool follows) {
    KeyframeMap map{DefaultConfig{}};
    const auto still = [](double) { return Pose{}; };
    Pose T;
    for (int k = 0; k < kEnough; ++k) {  // far away and forgotten: what counts is the last
      const test::ObservedScan scan({}, still, static_cast<std::uint64_t>(k));
      T.translation_m.x() = kApart_m * k;
      map.grow({scan.timing(), scan.features(), solution_at(T), T});
    }
    const test::ObservedScan held(test::yard(), still, kEnough);
    T.translation_m.x() += kApart_m;
    map.grow({held.timing(), held.features(), solution_at(T), T});
    const test::ObservedScan next(test::yard(), still, follows ? kEnough + 1 : kEnough + 5);
    Solution solution = solution_at(T);
    solution.trajectory.knots[4] = 0.4;  // y of the first knot
    map.grow({next.timing(), next.features(), solution, T, use});
    double sum_m = 0.0;
    int count = 0;
    map.cells().for_each_mean([&](const Eigen::Vector3d& mean_m) {
      sum_m += mean_m.y();
      ++count;
    });
    EXPECT_GT(count, 100);
    return sum_m / std::max(count, 1);
  };
  const double moved_m = mean_y_m(MapUse::end_only, true);
  EXPECT_GT(moved_m, mean_y_m(MapUse::none, true) + 0.1) << "it was not aligned";
  EXPECT_GT(moved_m, mean_y_m(MapUse::end_only, false) + 0.1) << "firings are missing";
}

// From a room through a door: the keyframe was seen in the room, the next scan outside.
TEST_F(KeyframeMapTest, AKeyframeEntersAtTheLevelOfItsOwnSurroundings) {
  fill();
  Pose T{Eigen::Quaterniond::Identity(), {9.0, 0.0, 0.0}};
  const auto take = [&](std::size_t finest_level, MapUse use) {
    const test::ObservedScan scan(
        test::yard(), [&](double) { return T; }, count_++);
    const bool is_room = finest_level == LocalMaps::kHalf;
    map_.grow({scan.timing(), scan.features(), solution_at(T), T, use, finest_level, is_room});
  };
  const auto half_cells = [&] {
    return map_.cells().at(LocalMaps::kHalf, FeatureKind::structure).size();
  };
  ASSERT_EQ(half_cells(), 0);
  take(LocalMaps::kHalf, MapUse::keyframe);
  take(LocalMaps::kWhole, MapUse::end_only);
  EXPECT_GT(half_cells(), 0);
}

TEST_F(KeyframeMapTest, BeginsWithOneScanAtOnce) {
  fill();
  const test::ObservedScan scan(
      test::yard(), [](double) { return Pose{}; }, 0);
  map_.begin(scan.features(), solution_at({}).trajectory, LocalMaps::kWhole);
  EXPECT_EQ(map_.keyframes(), 1);
  KeyframeMap fresh{DefaultConfig{}};
  fresh.begin(scan.features(), solution_at({}).trajectory, LocalMaps::kWhole);
  EXPECT_EQ(map_.cells().size(), fresh.cells().size()) << "nothing of before is left";
}

// Of a keyframe that waits too: it enters after the subtraction.
TEST_F(KeyframeMapTest, WithoutARigidMotionSensitivitiesAreThoseOfPointsAlone) {
  PoseSensitivity rigid;
  rigid.moved.col(2) << 0.1F, -0.2F, 0.3F, 4.0F, 5.0F, 6.0F;
  rigid.place_m = {10.0, 20.0, 1.0};
  ScanSensitivity alone;
  alone.correction.common_part.fill(1.0F);
  ScanSensitivity with_path = alone;
  with_path.pose = rigid.expressed_at({1.0, 0.0, 0.0});
  KeyframeMap other{DefaultConfig{}};
  for (int k = 0; k <= kEnough; ++k) {
    const bool is_last = k == kEnough;
    if (is_last) map_.subtract_sensitivity(rigid);
    map_.set_sensitivity(is_last ? alone : with_path);
    other.set_sensitivity(alone);
    Pose T{Eigen::Quaterniond::Identity(), {kApart_m * k, 0.0, 0.0}};
    const test::ObservedScan scan(
        test::yard(), [&](double) { return T; }, static_cast<std::uint64_t>(k));
    for (KeyframeMap* map : {&map_, &other}) {
      map->grow({scan.timing(), scan.features(), solution_at(T), T});
    }
  }
  int compared = 0;
  const auto sensitivity_at = [](const CellMap& cells, const Eigen::Vector3d& point_m) {
    return cells.sensitivity_around(cells.cell_at(cells.key_of(point_m))).sensitivity;
  };
  for (const FeatureKind kind : {FeatureKind::ground, FeatureKind::structure}) {
    const CellMap& cells = map_.cells().at(LocalMaps::kWhole, kind);
    const CellMap& expected = other.cells().at(LocalMaps::kWhole, kind);
    ASSERT_EQ(cells.size(), expected.size());
    cells.for_each_mean([&](const Eigen::Vector3d& mean_m) {
      EXPECT_LT((sensitivity_at(cells, mean_m) - sensitivity_at(expected, mean_m)).norm(), 2e-3);
      ++compared;
    });
  }
  EXPECT_GT(compared, 100);
}

TEST_F(KeyframeMapTest, IsEmptyAfterClear) {
  fill();
  map_.clear();
  EXPECT_EQ(map_.cells().size(), 0);
  EXPECT_EQ(map_.keyframes(), 0);
  EXPECT_TRUE(grow(0.0));
}

}  // namespace
}  // namespace lilo::core
