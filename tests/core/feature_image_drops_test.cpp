// SPDX-License-Identifier: BSD-3-Clause
// Which returns count as drops in the air, by where their neighbours are.
#include "core/image/feature_image.hpp"
#include "tests/core/analytic_scene.hpp"
#include "tests/core/image_returns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <set>
#include <span>
#include <vector>

namespace lilo {
namespace {

using test::azimuth_of;
using test::return_at;

const BeamTable k16 = test::even_beams(16, -15.0, 15.0);

/// A part of the rays meet a drop 1 to 12 m away, unless something is nearer. Such returns have a
/// negative stamp.
void add_drops(Scan& scan, double part, std::mt19937& rng) {
  std::uniform_real_distribution<double> chance, range_m(1.0, 12.0);
  for (Return& r : scan.returns) {
    const auto stretch =
        static_cast<float>(range_m(rng)) / std::max(1.0F, std::hypot(r.x_m, r.y_m, r.z_m));
    if (chance(rng) >= part || stretch >= 1.0F) continue;
    r = {.x_m = r.x_m * stretch,
         .y_m = r.y_m * stretch,
         .z_m = r.z_m * stretch,
         .azimuth_rad = r.azimuth_rad,
         .t_ns = -1,
         .ring = r.ring};
  }
}

/// Features of drops and of other returns.
std::array<int, 2> drops_and_others(const std::vector<Feature>& features, const Scan& scan) {
  std::set<std::array<float, 3>> drops;
  for (const Return& r : scan.returns) {
    if (r.t_ns < 0) drops.insert({r.x_m, r.y_m, r.z_m});
  }
  std::array<int, 2> count{};
  for (const Feature& f : features) ++count[drops.contains({f.x_m, f.y_m, f.z_m}) ? 0 : 1];
  return count;
}

/// A square of 80 m with four poles.
test::Scene square() {
  test::Scene scene = test::yard();
  for (test::Plane& plane : scene.planes) {
    if (plane.normal.z() == 0.0) plane.offset_m = -40.0;
  }
  return scene;
}

// A tenth of the rays meet a drop, as in dense fog. Walls, ground and poles stay, but for that
// tenth.
TEST(FeatureImageDrops, AreLeftOutWhereTheyAreMany) {
  for (const int columns : {720, 1024, 2304}) {
    std::mt19937 rng(1);
    Scan scan = test::still_scan_of(square(), k16, {});
    core::FeatureImage clear(columns, {}), image(columns, {});
    const auto of_clear = static_cast<double>(clear.build(scan).size());
    add_drops(scan, 0.1, rng);
    const auto offered = std::count_if(scan.returns.begin(), scan.returns.end(),
                                       [](const Return& r) { return r.t_ns < 0; });
    const auto [drops, others] = drops_and_others(image.build(scan), scan);
    EXPECT_LT(drops, offered / 10) << columns << " columns, of " << offered;
    EXPECT_GT(others, 0.8 * of_clear) << columns << " columns, of " << of_clear;
  }
}

// They are twigs and wires.
TEST(FeatureImageDrops, AFewSingleReturnsAreKept) {
  std::mt19937 rng(1);
  Scan scan = test::still_scan_of(square(), k16, {});
  add_drops(scan, 0.003, rng);
  core::FeatureImage image(1024, {});
  EXPECT_GT(drops_and_others(image.build(scan), scan)[0], 30);
}

constexpr int kManyColumns = 2048;  // three to either side have neighbours of a return
Return at(int column, std::uint8_t ring, double range_m) {
  return return_at(k16, ring, azimuth_of(column, kManyColumns), range_m);
}

Scan empty_scan() {
  Scan scan;
  scan.beams = k16;
  scan.end_ns = 100'000'000;
  return scan;
}

/// Single returns, 16 columns apart.
Scan singles(int count, double range_m, std::uint8_t ring = 9) {
  Scan scan = empty_scan();
  for (int k = 0; k < count; ++k) scan.returns.push_back(at(16 * k, ring, range_m));
  return scan;
}

TEST(FeatureImageDrops, AreLeftOutIfMoreThanAHundred) {
  core::FeatureImage image(kManyColumns, {});
  EXPECT_EQ(image.build(singles(100, 10.0)).size(), 100U);
  EXPECT_EQ(image.build(singles(101, 10.0)).size(), 0U);
}

TEST(FeatureImageDrops, AreSeenUpTo30Metres) {
  core::FeatureImage image(kManyColumns, {});
  EXPECT_EQ(image.build(singles(101, 31.0)).size(), 101U);
  Scan scan = singles(101, 29.0);
  const Scan far = singles(50, 31.0, 12);
  scan.returns.insert(scan.returns.end(), far.returns.begin(), far.returns.end());
  EXPECT_EQ(image.build(scan).size(), 50U) << "those 31 m away";
}

// In parts, so that nothing is counted again at the end.
TEST(FeatureImageDrops, CountsNothingOfTheScanBefore) {
  core::FeatureImage image(kManyColumns, {});
  const Scan scan = singles(60, 10.0);
  for (int k = 0; k < 2; ++k) {
    image.begin(scan.beams);
    for (const Return& r : scan.returns) image.add({&r, 1});
    EXPECT_EQ(image.finish(scan).size(), 60U);
  }
}

// Beside a wall that one ring sees: 110 are a fifth of 550.
TEST(FeatureImageDrops, AreLeftOutIfMoreThanAFifth) {
  core::FeatureImage image(kManyColumns, {});
  for (const int wall : {400, 500}) {
    Scan scan = singles(110, 10.0);
    for (int column = 0; column < wall; ++column) scan.returns.push_back(at(column, 13, 10.0));
    EXPECT_EQ(image.build(scan).size(), wall == 400 ? 400U : 610U) << wall;
  }
}

// Two rings of a post are neighbours of each other, with a steep edge.
TEST(FeatureImageDrops, StructureWithSteepEdgesIsNotCounted) {
  core::FeatureImage image(kManyColumns, {});
  Scan scan = singles(101, 10.0);
  for (int k = 0; k < 101; ++k) scan.returns.push_back(at(16 * k, 10, 10.0));
  EXPECT_EQ(image.build(scan).size(), 202U);
}

// 101 returns, and two to one side of each. The scan may begin within one of these groups.
TEST(FeatureImageDrops, NeighboursAreUpToThreeColumnsAndOneRingAway) {
  core::FeatureImage image(kManyColumns, {});
  const auto kept = [&](int aside, std::uint8_t ring, double range_m) {
    Scan scan = empty_scan();
    for (int column = 8; column < 8 + 16 * 101; column += 16) {
      scan.returns.push_back(at(column, 9, 10.0));
      scan.returns.push_back(at(column + aside, ring, range_m));
      scan.returns.push_back(at(column + aside + (aside < 0 ? 1 : -1), ring, range_m));
    }
    const std::vector<Feature>& features = image.build(scan);
    return std::count_if(features.begin(), features.end(),
                         [](const Feature& f) { return f.column % 16 == 8 && f.ring == 9; });
  };
  for (const int side : {-1, 1}) {
    EXPECT_GE(kept(side * 3, 9, 10.9), 100) << side;
    EXPECT_EQ(kept(side * 4, 9, 10.9), 0) << side;
    EXPECT_GE(kept(side * 3, 10, 10.9), 100) << side;
    EXPECT_GE(kept(side * 3, 8, 10.9), 100) << side;
    EXPECT_EQ(kept(side * 3, 11, 10.9), 0) << side;
    EXPECT_EQ(kept(side * 3, 7, 10.9), 0) << side;
    EXPECT_EQ(kept(side * 3, 9, 11.1), 0) << side;
    EXPECT_GE(kept(side * 3, 9, 9.1), 100) << side;
    EXPECT_EQ(kept(side * 3, 9, 8.9), 0) << side;
  }
}

// 101 isolated returns. Two neighbours of one of them come late, when columns near by may have been
// classified: 100 are left, and are kept.
TEST(FeatureImageDrops, LateNeighboursCount) {
  core::FeatureImage image(kManyColumns, {});
  for (int front = 1000; front < 1032; ++front) {
    const int last_classified = front - 115;  // by kFiringSpread_rad
    for (int column = last_classified - 60; column < last_classified + 60; ++column) {
      if (column % 16 > 13) continue;  // nearer to the next return
      Scan scan = empty_scan();
      for (int k = 0; 16 * k < front; ++k) scan.returns.push_back(at(16 * k, 9, 10.0));
      scan.returns.push_back(at(front, 14, 50.0));
      const std::size_t early = scan.returns.size();
      for (const int k : {0, 1}) scan.returns.push_back(at(column + k, 9, 10.0));
      for (int k = (front + 15) / 16; k < 101; ++k) scan.returns.push_back(at(16 * k, 9, 10.0));
      image.begin(k16);
      image.add(std::span(scan.returns).first(early));
      image.add(std::span(scan.returns).subspan(early));
      const std::size_t in_parts = image.finish(scan).size();
      ASSERT_EQ(in_parts, image.build(scan).size()) << front << " " << column;
    }
  }
}

// A post as wide as one firing, in fog.
TEST(FeatureImageDrops, AThinPostAmongThemIsKept) {
  constexpr int kColumns = 360;
  std::mt19937 rng(1);
  test::Scene plain;
  plain.planes = {{{0.0, 0.0, 1.0}, -1.5}};
  Scan scan = test::still_scan_of(plain, test::even_beams(16, -15.0, 0.0), {});
  add_drops(scan, 0.3, rng);
  std::erase_if(scan.returns,
                [](const Return& r) { return std::abs(r.azimuth_rad - 1.0F) < 0.1F; });
  for (std::uint8_t ring = 0; ring < 16; ++ring) {
    scan.returns.push_back(return_at(scan.beams, ring, 1.0, 8.0));
  }
  core::FeatureImage image(kColumns, {});
  int of_post = 0;
  for (const Feature& f : image.build(scan)) {
    if (std::abs(std::atan2(f.y_m, f.x_m) - 1.0F) < 0.05F) ++of_post;
  }
  EXPECT_EQ(of_post, 14);  // the end rings have one neighbour
}

}  // namespace
}  // namespace lilo
