// SPDX-License-Identifier: BSD-3-Clause
// Which features are taken.
#include "core/image/selection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace lilo::core {
namespace {

// Open ground fills every column with the same rings; `s` tells the column.
std::vector<Feature> filled_columns(int columns, int rings, float range_m = 10.0F) {
  std::vector<Feature> all;
  for (int column = 0; column < columns; ++column) {
    for (int ring = 0; ring < rings; ++ring) {
      Feature f{};
      f.x_m = range_m;
      f.s = static_cast<float>(column);
      f.ring = static_cast<std::uint8_t>(ring);
      all.push_back(f);
    }
  }
  return all;
}

TEST(ThinOut, LeavesNoRingAndNoDirectionOut) {
  constexpr int kColumns = 1000, kRings = 8;
  const std::vector<Feature> all = filled_columns(kColumns, kRings);
  std::vector<Feature> fewer;
  for (const auto& [step, evenly] : {std::pair{2, Evenly::in_image},
                                     {3, Evenly::in_image},
                                     {4, Evenly::in_image},
                                     {8, Evenly::in_image},
                                     {2, Evenly::along_rings},
                                     {8, Evenly::along_rings}}) {
    thin_out(all, all.size() / static_cast<std::size_t>(step), evenly, fewer);
    std::array<int, kRings> count{}, last{};
    last.fill(-1);
    for (const Feature& f : fewer) {
      const int column = static_cast<int>(f.s);
      EXPECT_LE(column - last[f.ring], step + 1) << "ring " << int{f.ring};
      last[f.ring] = column;
      ++count[f.ring];
    }
    const int each = kColumns / step;
    for (const int n : count) EXPECT_NEAR(n, each, 1) << "every " << step;
  }
}

TEST(ThinOut, LeavesOutWhatIsOverhead) {
  std::vector<Feature> all = filled_columns(1000, 8);
  for (std::size_t k = 0; k < all.size(); ++k) all[k].z_m = k % 3 == 0 ? 2.0F : -1.5F;
  const std::size_t below = all.size() - (all.size() + 2) / 3;
  std::vector<Feature> fewer;
  for (const std::size_t most : {below / 3, 2 * below}) {
    thin_out(all, most, Evenly::along_rings, fewer, false);
    EXPECT_NEAR(static_cast<double>(fewer.size()), static_cast<double>(std::min(most, below)), 8.0);
    EXPECT_TRUE(std::none_of(fewer.begin(), fewer.end(), is_overhead));
  }
}

TEST(ThinOut, NeverTakesMoreThanItMay) {
  std::vector<Feature> fewer;
  for (const std::size_t most : {1UL, 7UL, 999UL, 6000UL}) {
    thin_out(filled_columns(1023, 7), most, Evenly::along_rings, fewer);
    EXPECT_LE(fewer.size(), most);
    EXPECT_GE(fewer.size() + 7, most);
  }
}

// Returns lie ten times as far apart at ten times the range, and are kept ten times as often.
TEST(ThinOut, KeepsTheSameOfAMetreNearAndFar) {
  constexpr std::size_t kOfEach = 8000;
  std::vector<Feature> all = filled_columns(1000, 8, 5.0F);
  const std::vector<Feature> far = filled_columns(1000, 8, 50.0F);
  all.insert(all.end(), far.begin(), far.end());
  for (const std::size_t most : {1100UL, 4400UL, 10000UL}) {
    std::vector<Feature> fewer;
    thin_out(all, most, Evenly::along_rings, fewer);
    const auto near = static_cast<double>(
        std::count_if(fewer.begin(), fewer.end(), [](const Feature& f) { return f.x_m < 10.0F; }));
    const double far_kept = static_cast<double>(fewer.size()) - near;
    const bool all_far = most > kOfEach;
    const double far_expected = all_far ? kOfEach : static_cast<double>(most) * 10.0 / 11.0;
    EXPECT_NEAR(far_kept, far_expected, 10.0) << most;
    EXPECT_NEAR(near, static_cast<double>(most) - far_expected, 10.0) << most;
  }
}

TEST(ThinOut, TakesAllOfFew) {
  std::vector<Feature> fewer;
  thin_out(filled_columns(10, 4), 40, Evenly::along_rings, fewer);
  EXPECT_EQ(fewer.size(), 40U);
}

// The first scan of a corridor 2 m wide, 6 m of it: 5 cm from return to return.
TEST(Selection, TakesEnoughOfANarrowPlaceAtOnce) {
  std::vector<Feature> all;
  for (int k = 0; k < 8000; ++k) {
    Feature f{};
    f.x_m = 0.05F * static_cast<float>(k % 120);
    f.y_m = k % 2 == 0 ? -1.0F : 1.0F;
    f.z_m = 0.05F * static_cast<float>(k / 120 % 30);
    f.kind = FeatureKind::structure;
    all.push_back(f);
  }
  Selection selection(900, 1100);
  EXPECT_GE(selection.choose(all).size(), 550U);
}

// Ten returns a metre along a wall, in azimuth order. What is taken of a voxel is as often on its
// one side as on the other: the first would lie 0.45 m before the middle.
TEST(Selection, FavoursNoSideOfAVoxel) {
  constexpr int kPerMetre = 10, kLength_m = 400;
  std::vector<Feature> all;
  for (int k = 0; k < kPerMetre * kLength_m; ++k) {
    Feature f{};
    f.x_m = (static_cast<float>(k) + 0.5F) / kPerMetre;
    f.kind = FeatureKind::structure;
    all.push_back(f);
  }
  Selection selection(400, kLength_m);
  for (int scan = 0; scan < 30; ++scan) selection.choose(all);  // voxels follow the goal
  double from_middle_m = 0.0;
  const std::vector<Feature>& chosen = selection.choose(all);
  for (const Feature& f : chosen) {
    from_middle_m += static_cast<double>(f.x_m) - std::floor(static_cast<double>(f.x_m)) - 0.5;
  }
  EXPECT_NEAR(static_cast<double>(chosen.size()), kLength_m, 0.05 * kLength_m);
  EXPECT_LT(std::abs(from_middle_m) / static_cast<double>(chosen.size()), 0.05);
}

TEST(Selection, LeavesOutWhatIsOverhead) {
  std::vector<Feature> all(40);
  for (std::size_t k = 0; k < all.size(); ++k) {
    all[k].x_m = static_cast<float>(2 * k);
    all[k].z_m = k % 2 == 0 ? 1.0F : -1.0F;
  }
  Selection selection(900, 1100);
  EXPECT_EQ(selection.choose(all, false).size(), all.size() / 2);
  EXPECT_EQ(selection.choose(all, true).size(), all.size());
}

TEST(Selection, TakesWhatThereIs) {
  std::vector<Feature> few(40);
  for (std::size_t k = 0; k < few.size(); ++k) few[k].x_m = static_cast<float>(2 * k);
  Selection selection(900, 1100);
  EXPECT_EQ(selection.choose(few).size(), few.size());
}

}  // namespace
}  // namespace lilo::core
