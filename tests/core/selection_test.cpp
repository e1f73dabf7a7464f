// Which features are taken.
#include "core/image/selection.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace lilo::core {
namespace {

// Open ground fills every column with the same rings.
std::vector<Feature> filled_columns(int columns, int rings) {
  std::vector<Feature> all;
  for (int column = 0; column < columns; ++column) {
    for (int ring = 0; ring < rings; ++ring) {
      Feature f{};
      f.x_m = static_cast<float>(column);
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
  for (const int step : {2, 3, 4, 8}) {
    thin_out(all, all.size() / static_cast<std::size_t>(step), fewer);
    std::array<int, kRings> count{}, last{};
    last.fill(-1);
    for (const Feature& f : fewer) {
      const int column = static_cast<int>(f.x_m);
      EXPECT_LE(column - last[f.ring], step + 1) << "ring " << int{f.ring};
      last[f.ring] = column;
      ++count[f.ring];
    }
    const int each = kColumns / step;
    for (const int n : count) EXPECT_NEAR(n, each, 1) << "every " << step;
  }
}

TEST(ThinOut, NeverTakesMoreThanItMay) {
  std::vector<Feature> fewer;
  for (const std::size_t most : {1UL, 7UL, 999UL, 6000UL}) {
    thin_out(filled_columns(1023, 7), most, fewer);
    EXPECT_LE(fewer.size(), most);
    EXPECT_GE(fewer.size() + 7, most);
  }
}

TEST(ThinOut, TakesAllOfFew) {
  std::vector<Feature> fewer;
  thin_out(filled_columns(10, 4), 40, fewer);
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

TEST(Selection, TakesWhatThereIs) {
  std::vector<Feature> few(40);
  for (std::size_t k = 0; k < few.size(); ++k) few[k].x_m = static_cast<float>(2 * k);
  Selection selection(900, 1100);
  EXPECT_EQ(selection.choose(few).size(), few.size());
}

}  // namespace
}  // namespace lilo::core
