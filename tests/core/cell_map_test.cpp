// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/cell_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace lilo::core {
namespace {

class Filled : public testing::Test {
 protected:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(rng_);
  }
  std::mt19937 rng_{11};
  CellMap map_{CellMapConfig{}};
  const Eigen::Vector3f no_reach_ = Eigen::Vector3f::Zero();
};

TEST_F(Filled, AWallInformsAlongItsNormalOnly) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.8, 0.6, 0.0);
  const Eigen::Vector3d along(-0.6, 0.8, 0.0);
  for (int k = 0; k < 4000; ++k) {
    map_.insert(100.2 * along + uniform(-3, 3) * along + uniform(-3, 3) * Eigen::Vector3d::UnitZ(),
                no_reach_);
  }
  const Eigen::Vector3d probe = 100.2 * along + 0.02 * normal;
  const Match match = map_.find(probe);
  ASSERT_NE(match.information, nullptr);
  EXPECT_NEAR(match.from_mean_m.dot(normal.cast<float>()), 0.02F, 0.002F);
  const Eigen::Matrix3f O = matrix_of(*match.information);
  const Eigen::Vector3f n = normal.cast<float>(), t = along.cast<float>();
  EXPECT_GT(n.dot(O * n), 1000.0F);
  EXPECT_LT(t.dot(O * t), 0.01F * n.dot(O * n));
  EXPECT_LT(O(2, 2), 0.01F * n.dot(O * n));
}

// A wall of a room is seen again in the next room, from the other side and by its width nearer.
TEST_F(Filled, AWallIsMatchedOnlyFromTheSideItWasSeenFrom) {
  for (int k = 0; k < 4000; ++k) {
    const Eigen::Vector3d on_wall(5.0, uniform(-3, 3), uniform(-3, 3));
    map_.insert(on_wall, no_reach_, on_wall.cast<float>().normalized());  // from the origin
  }
  const Eigen::Vector3d probe(5.1, 1.0, 0.2);
  const auto knows = [&](const Eigen::Vector3f& ray) {
    return map_.find(probe, ray).information != nullptr;
  };
  EXPECT_TRUE(knows({1.0F, 0.0F, 0.0F}));
  EXPECT_TRUE(knows({0.2F, -1.0F, 0.3F}));  // along the wall
  EXPECT_FALSE(knows({-1.0F, 0.0F, 0.0F}));
  EXPECT_FALSE(knows({-0.2F, 1.0F, 0.3F}));
  EXPECT_TRUE(knows({0.0F, 0.0F, 0.0F}));  // from both sides, then
}

// Below a landing the sensor sees its lower face, and on it the upper one.
TEST_F(Filled, ALandingIsMatchedOnlyFromTheSideItWasSeenFrom) {
  CellMap ground({.level = true});
  for (int k = 0; k < 4000; ++k) {
    const Eigen::Vector3d on_ceiling(uniform(2, 8), uniform(-3, 3), 1.2);
    ground.insert(on_ceiling, no_reach_, on_ceiling.cast<float>().normalized());
  }
  const Eigen::Vector3d probe(5.0, 0.0, 1.3);
  const auto knows = [&](const Eigen::Vector3f& ray) {
    return ground.find(probe, ray).information != nullptr;
  };
  EXPECT_TRUE(knows({1.0F, 0.0F, 0.1F}));
  EXPECT_FALSE(knows({1.0F, 0.0F, -0.1F}));
}

TEST_F(Filled, ATrunkInformsAcrossItsAxisOnly) {
  for (int k = 0; k < 2000; ++k) {
    const double angle = uniform(0.0, 3.1);  // the side that is seen
    map_.insert({5.0 + 0.05 * std::cos(angle), -3.0 + 0.05 * std::sin(angle), uniform(-3, 3)},
                no_reach_);
  }
  const Match match = map_.find({5.0, -3.0, 0.3});
  ASSERT_NE(match.information, nullptr);
  const Eigen::Matrix3f O = matrix_of(*match.information);
  EXPECT_GT(O(0, 0), 100.0F);
  EXPECT_GT(O(1, 1), 100.0F);
  EXPECT_LT(O(2, 2), 0.01F * O(0, 0));
}

// From step to step of an alignment a point stays in its cell or goes over to one beside it.
TEST_F(Filled, FindsTheCellWhereverThePointWasBefore) {
  for (int k = 0; k < 2000; ++k) map_.insert({uniform(0, 5), uniform(0, 5), 0.2}, no_reach_);
  int same = 0, other = 0, gone = 0;
  for (int k = 0; k < 1000; ++k) {
    const Eigen::Vector3d before(uniform(0, 5), uniform(0, 5), 0.2);
    const Eigen::Vector3d now = before + Eigen::Vector3d(uniform(-1, 1), 0.0, uniform(-0.3, 0.3));
    const std::int32_t last = map_.cell_at(map_.key_of(before));
    const std::int32_t cell = map_.cell_at(map_.key_of(now, last));
    EXPECT_EQ(cell, map_.cell_at(map_.key_of(now)));
    ++(cell == CellMap::kNone ? gone : cell == last ? same : other);
  }
  EXPECT_GT(std::min({same, other, gone}), 100);
}

// What is seen of a thing changes as the sensor passes it; the map must follow.
TEST_F(Filled, OldViewsFade) {
  const auto fill = [&](double x_m) {
    for (int k = 0; k < 6000; ++k) map_.insert({x_m, uniform(-3, 3), uniform(-3, 3)}, no_reach_);
    map_.end_keyframe();
    map_.end_keyframe();
  };
  fill(0.20);
  EXPECT_NEAR(map_.find({0.20, 0.1, 0.1}).from_mean_m.x(), 0.0F, 1e-3F);
  for (int k = 0; k < 4; ++k) fill(0.30);  // 160 points a cell: five times what it remembers
  EXPECT_NEAR(map_.find({0.30, 0.1, 0.1}).from_mean_m.x(), 0.0F, 0.002F);
}

TEST_F(Filled, FoliageInformsNowhere) {
  for (int k = 0; k < 4000; ++k) {
    map_.insert({uniform(-2, 2), uniform(-2, 2), uniform(-2, 2)}, no_reach_);
  }
  EXPECT_EQ(map_.find({0.2, 0.2, 0.2}).information, nullptr);
}

// One ring on a slope is a thin line in two directions. Without its reach it would claim to know
// the height and, being thin across the beam too, hold the scan to its own cone.
TEST_F(Filled, ASingleRingOnTheGroundSaysNothingAlongItsBeam) {
  const double slope = 0.1;  // of the ground, along x
  for (int k = 0; k < 60; ++k) {
    map_.insert({6.0, uniform(-0.7, 0.7), 0.6}, Eigen::Vector3f(1.2F, 0.0F, 0.12F));
  }
  const Match match = map_.find({6.0, 0.1, 0.6});
  ASSERT_NE(match.information, nullptr);
  const Eigen::Matrix3f O = matrix_of(*match.information);
  const Eigen::Vector3f up = Eigen::Vector3f(static_cast<float>(-slope), 0.0F, 1.0F).normalized();
  const Eigen::Vector3f outward =
      Eigen::Vector3f(1.0F, 0.0F, static_cast<float>(slope)).normalized();
  EXPECT_GT(up.dot(O * up), 500.0F);
  EXPECT_LT(outward.dot(O * outward), 0.01F * up.dot(O * up));
}

// Before a wall the lowest ring sees a strip of ground, at the same distance wherever the sensor
// is.
TEST_F(Filled, AStripOfGroundSaysNothing) {
  CellMap ground({.level = true});
  for (int k = 0; k < 2000; ++k) {
    const double x_m = -2.9 + uniform(-0.08, 0.08);
    const Eigen::Vector3d p(x_m, uniform(-2.0, 2.0),
                            -0.8 - 0.3 * (x_m + 2.9));  // to the wall's foot
    map_.insert(p, no_reach_);
    ground.insert(p, no_reach_);
  }
  EXPECT_EQ(ground.find({-2.9, 0.1, -0.8}).information, nullptr);
  const Match of_rail = map_.find({-2.9, 0.1, -0.8});  // a rail of that width says where it is
  ASSERT_NE(of_rail.information, nullptr);
  EXPECT_GT(matrix_of(*of_rail.information)(0, 0), 30.0F);
}

TEST_F(Filled, GroundSaysHowHighItIsAndHowItLeans) {
  CellMap ground({.level = true});
  for (int k = 0; k < 2000; ++k) {
    const double x_m = uniform(-1.0, 1.0);
    ground.insert({x_m, uniform(-1.0, 1.0), -0.8 + 0.2 * x_m}, no_reach_);
    ground.insert({6.0, uniform(-1.0, 1.0), uniform(-1.0, 1.0)}, no_reach_);  // passes for ground
  }
  const Match match = ground.find({0.1, 0.1, -0.8});
  ASSERT_NE(match.information, nullptr);
  const Eigen::Matrix3f O = matrix_of(*match.information);
  EXPECT_GT(O(2, 2), 1000.0F);
  EXPECT_NEAR(O(0, 2) / O(2, 2), -0.2F, 0.02F);
  EXPECT_LT(O(1, 1), 1e-3F * O(2, 2));
  EXPECT_EQ(ground.find({6.0, 0.1, 0.1}).information, nullptr);
}

TEST_F(Filled, KnowsNothingWhereNothingWasSeen) {
  EXPECT_EQ(map_.find({1.0, 2.0, 3.0}).information, nullptr);
  for (int k = 0; k < 5; ++k) map_.insert({0.1, 0.1, 0.1}, no_reach_);  // one too few
  EXPECT_EQ(map_.find({0.1, 0.1, 0.1}).information, nullptr);
}

TEST_F(Filled, ForgetsWhatIsFarAndFindsTheRest) {
  for (int x = 0; x < 400; ++x) {
    for (int k = 0; k < 8; ++k) {
      map_.insert({x + uniform(0, 0.4), uniform(0, 0.4), 0.25}, no_reach_);
    }
  }
  const int before = map_.size();
  for (int turn = 0; turn < 100; ++turn) map_.forget_beyond({0.0, 0.0, 0.0}, 100.0);
  EXPECT_LT(map_.size(), before / 2);
  for (int x = 0; x < 99; ++x) {
    EXPECT_NE(map_.find({x + 0.2, 0.2, 0.25}).information, nullptr) << x;
  }
  for (int x = 101; x < 400; ++x) {
    EXPECT_EQ(map_.find({x + 0.2, 0.2, 0.25}).information, nullptr) << x;
  }
}

// As far as load_config() lets them be: the radius and the farthest point together are as many
// cells as the tags' window is high.
TEST_F(Filled, ForgetsWhatIsFarUpToTheWindowOfTheTags) {
  const auto farthest = static_cast<int>(0.5 * CellTable::kSafeLevels - 100.0);
  for (int way_m = 101; way_m < farthest; ++way_m) {
    for (const double sign : {-1.0, 1.0}) {
      map_.insert({sign * way_m, 0.25, 0.25}, no_reach_);
      map_.insert({0.25, sign * way_m, 0.25}, no_reach_);
      map_.insert({0.25, 0.25, sign * way_m}, no_reach_);
    }
  }
  EXPECT_GT(map_.size(), 1500);
  for (int turn = 0; turn < 100; ++turn) map_.forget_beyond({0.0, 0.0, 0.0}, 100.0);
  EXPECT_EQ(map_.size(), 0);
}

// Where a pose ran away there are points that no cell's index can hold.
TEST_F(Filled, PlacesBeyondAllCellsAreUnknownAndDoNoHarm) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double far_m : {1e9, -1e9, 1e18, -1e300, nan}) {
    EXPECT_EQ(map_.find({far_m, far_m, far_m}).information, nullptr) << far_m;
    map_.insert({far_m, 0.0, 0.0}, no_reach_);
  }
  EXPECT_GT(map_.size(), 0);
  for (int k = 0; k < 8; ++k) map_.insert({uniform(0, 0.4), uniform(0, 0.4), 0.25}, no_reach_);
  EXPECT_NE(map_.find({0.2, 0.2, 0.25}).information, nullptr);
}

TEST(CellMap, RefusesCellsBeyondItsCapacityAndCountsThem) {
  CellMap map({.capacity = 10});
  for (int k = 0; k < 25; ++k) map.insert({2.0 * k, 0.0, 0.0}, Eigen::Vector3f::Zero());
  EXPECT_EQ(map.size(), 10);
  EXPECT_EQ(map.refused(), 15U);
}

// A wall on either side along 400 m: the last 100 m have twice as many cells as the map.
TEST_F(Filled, ANearlyFullMapForgetsTheFarthestAndRefusesNothing) {
  CellMap map({.capacity = 4000});
  for (int along = 0; along < 4000; ++along) {
    const double x_m = 0.1 * along;
    for (int k = 0; k < 40; ++k) {
      map.insert({x_m, k % 2 == 0 ? -5.0 : 5.0, 0.25 * k}, no_reach_);
    }
    map.end_keyframe();
    map.forget_beyond({x_m, 0.0, 0.0}, 100.0);
  }
  EXPECT_EQ(map.refused(), 0U);
  EXPECT_GT(map.size(), 3000);
  for (double back_m = 0.25; back_m < 15.0; back_m += 0.5) {
    EXPECT_NE(map.find({399.9 - back_m, 5.0, 5.0}).information, nullptr) << back_m;
  }
  EXPECT_EQ(map.find({320.0, 5.0, 5.0}).information, nullptr);
}

TEST_F(Filled, GivesTheMeanOfEveryCell) {
  map_.insert({0.1, 0.1, 0.1}, no_reach_);
  map_.insert({0.3, 0.1, 0.1}, no_reach_);
  map_.insert({-1000.2, 7.4, 3.1}, no_reach_);
  std::vector<Eigen::Vector3f> means;
  map_.for_each_mean([&](const Eigen::Vector3d& mean_m) { means.push_back(mean_m.cast<float>()); });
  ASSERT_EQ(means.size(), 2U);
  if (means[0].x() < 0.0F) std::swap(means[0], means[1]);
  EXPECT_LT((means[0] - Eigen::Vector3f(0.2F, 0.1F, 0.1F)).norm(), 1e-5F);
  EXPECT_LT((means[1] - Eigen::Vector3f(-1000.2F, 7.4F, 3.1F)).norm(), 2e-4F);
  map_.clear();
  means.clear();
  map_.for_each_mean([&](const Eigen::Vector3d& mean_m) { means.push_back(mean_m.cast<float>()); });
  EXPECT_TRUE(means.empty());
}

// Of ground the map keeps the height alone.
TEST(CellMapSensitivity, IsTheMeanAroundWithoutWhatIsSubtracted) {
  PoseSensitivity rigid;
  rigid.moved.col(1) << 1.0F, 2.0F, 3.0F, 40.0F, 50.0F, 60.0F;
  rigid.place_m = {5.0, 5.0, 5.0};
  for (const bool level : {false, true}) {
    CellMap map({.level = level, .with_sensitivity = true});
    const Eigen::Vector3d a_m(0.1, 0.1, 0.1), b_m(0.6, 0.2, 0.3);
    for (const Eigen::Vector3d& point_m : {a_m, b_m}) {
      const CellMap::CellKey key = map.key_of(point_m);
      map.add(map.find_or_insert(key), key, point_m, CellMap::SampleGap(Eigen::Vector3f::Zero()),
              Eigen::Vector3f::Zero(), rigid.at(point_m));
    }
    const std::int32_t cell = map.cell_at(map.key_of(a_m));
    const Sensitivity mean = 0.5F * (rigid.at(a_m) + rigid.at(b_m));
    const Sensitivity found = map.sensitivity_around(cell).sensitivity;
    EXPECT_LT((map.sensitivity_around(cell).mean_m - 0.5 * (a_m + b_m)).norm(), 1e-6);
    EXPECT_LT((found.row(2) - mean.row(2)).norm(), 1e-4) << level;
    EXPECT_LT((found.topRows<2>() - (level ? 0.0F : 1.0F) * mean.topRows<2>()).norm(), 1e-4);
    map.subtract_sensitivity(rigid);
    EXPECT_LT(map.sensitivity_around(cell).sensitivity.norm(), 1e-4) << level;
  }
}

}  // namespace
}  // namespace lilo::core
