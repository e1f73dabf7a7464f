// SPDX-License-Identifier: BSD-3-Clause
// Features are matched at the finest level of the map that knows their surroundings.
#include "core/map/local_maps.hpp"

#include <gtest/gtest.h>

#include <random>

namespace lilo::core {
namespace {

LocalMaps maps() {
  const auto level = [](float cell_m) {
    CellMapConfig ground{.cell_m = cell_m, .level = true, .capacity = 5000};
    CellMapConfig structure{.cell_m = cell_m, .capacity = 5000};
    return std::array{ground, structure};
  };
  return LocalMaps({level(0.25F), level(0.5F), level(1.5F)});
}

/// Points evenly spread over a piece of the wall x = 4, about the y axis.
std::vector<LocalMaps::Point> wall(double half_width_m) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> along(-half_width_m, half_width_m);
  constexpr int kPoints = 3000;
  std::vector<LocalMaps::Point> points;
  points.reserve(kPoints);
  for (int k = 0; k < kPoints; ++k) {
    points.push_back(
        {{4.0, along(rng), along(rng)}, Eigen::Vector3f::Zero(), FeatureKind::structure});
  }
  return points;
}

bool knows(LocalMaps& maps, std::size_t level, const Eigen::Vector3d& point_m) {
  return maps.at(level, FeatureKind::structure).find(point_m).information != nullptr;
}

TEST(LocalMaps, HalfCellsAreFilledInNarrowSurroundingsOnly) {
  LocalMaps outdoors = maps(), indoors = maps();
  outdoors.insert(wall(2.0), LocalMaps::kWhole);
  indoors.insert(wall(2.0), LocalMaps::kHalf);
  const Eigen::Vector3d probe(4.02, 0.1, 0.1);
  EXPECT_FALSE(knows(outdoors, LocalMaps::kHalf, probe));
  EXPECT_TRUE(knows(indoors, LocalMaps::kHalf, probe));
  for (LocalMaps* one : {&outdoors, &indoors}) {
    EXPECT_TRUE(knows(*one, LocalMaps::kWhole, probe));
    EXPECT_TRUE(knows(*one, LocalMaps::kCoarse, probe));
    EXPECT_FALSE(one->at(LocalMaps::kWhole, FeatureKind::ground).find(probe).information !=
                 nullptr);
  }
}

// A pillar 0.5 m before the wall: three cells of 0.5 m take both for one thick thing, three of
// 0.25 m tell them apart.
TEST(LocalMaps, HalfCellsTellApartWhatWholeOnesBlur) {
  LocalMaps both = maps();
  std::vector<LocalMaps::Point> points = wall(0.6);
  for (LocalMaps::Point& p : wall(0.6)) {
    p.point_m.x() -= 0.5;
    points.push_back(p);
  }
  both.insert(points, LocalMaps::kHalf);
  const Eigen::Vector3d on_wall(4.0, 0.1, 0.1);
  const Match narrow = both.at(LocalMaps::kHalf, FeatureKind::structure).find(on_wall);
  const Match usual = both.at(LocalMaps::kWhole, FeatureKind::structure).find(on_wall);
  ASSERT_NE(narrow.information, nullptr);
  EXPECT_NEAR(narrow.from_mean_m.x(), 0.0F, 0.01F);
  const float across = (*narrow.information)[0];
  EXPECT_GT(across, 500.0F);
  EXPECT_TRUE(usual.information == nullptr || (*usual.information)[0] < 0.1F * across);
}

TEST(LocalMaps, ForgetsHalfCellsNearer) {
  LocalMaps one = maps();
  one.insert(wall(2.0), LocalMaps::kHalf);
  for (int sweep = 0; sweep < 200; ++sweep) one.forget_beyond({-30.0, 0.0, 0.0}, 100.0);
  EXPECT_EQ(one.at(LocalMaps::kHalf, FeatureKind::structure).size(), 0);
  EXPECT_GT(one.at(LocalMaps::kWhole, FeatureKind::structure).size(), 0);
  one.clear();
  EXPECT_EQ(one.size(), 0);
}

}  // namespace
}  // namespace lilo::core
