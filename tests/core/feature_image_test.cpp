// SPDX-License-Identifier: BSD-3-Clause
// What the image plane says of returns, against scenes whose every range has a closed form.
#include "core/image/feature_image.hpp"

#include "core/map/cell_map.hpp"
#include "tests/core/analytic_scene.hpp"
#include "tests/core/image_returns.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace lilo {
namespace {

using test::azimuth_of;
using test::gap_of;
using test::return_at;

const BeamTable k16 = test::even_beams(16, -15.0, 15.0);

Eigen::Vector3d key_of(const Feature& f) {
  return Eigen::Vector3f(f.x_m, f.y_m, f.z_m).cast<double>();
}

TEST(FeatureImage, TellsGroundFromWalls) {
  const test::Scene scene = test::yard();
  const Scan scan = test::still_scan_of(scene, k16, {});
  core::FeatureImage image(1024, {});
  int ground = 0, structure = 0, wrong = 0;
  for (const Feature& f : image.build(scan)) {
    const bool on_ground = std::abs(static_cast<double>(f.z_m) + 1.5) < 1e-3;
    const bool said_ground = f.kind == FeatureKind::ground;
    (said_ground ? ground : structure)++;
    if (on_ground != said_ground) ++wrong;
  }
  EXPECT_GT(ground, 2000);
  EXPECT_GT(structure, 4000);
  EXPECT_LT(wrong, (ground + structure) / 100);
}

// A bar across the road, 30 m ahead, that one ring of 16 hits.
TEST(FeatureImage, WhatOneRingHitsMayBeAsHighAsTheNextOneLooks) {
  const double w = 3.0 * std::numbers::pi / 180.0, gap_rad = 2.0 * std::numbers::pi / 180.0;
  Scan scan;
  scan.beams = k16;
  scan.end_ns = 100'000'000;
  core::CellMap map({.cell_m = 0.5F});
  core::FeatureImage image(1024, {});
  for (int k = -10; k <= 10; ++k) {
    const double azimuth = 0.006 * k;
    scan.returns.push_back(return_at(k16, 9, azimuth, 30.0 / std::cos(azimuth)));
  }
  for (const Feature& f : image.build(scan)) {
    const Eigen::Vector3d p = key_of(f), up = gap_of(f);
    EXPECT_NEAR(up.norm(), p.norm() * gap_rad, 1e-3);
    EXPECT_NEAR(up.normalized().dot(p.normalized()), 0.0, 1e-5);
    EXPECT_GT(up.z(), 0.0);
    map.insert(p, up.cast<float>());
  }
  const core::Match match = map.find({30.0, 0.0, 30.0 * std::tan(w)});
  ASSERT_NE(match.information, nullptr);
  const core::Symmetric& i = *match.information;  // xx xy xz yy yz zz
  EXPECT_GT(i[0], 50.0F);                         // how far it is
  EXPECT_LT(i[5], 0.05F * i[0]);                  // but not how high
}

// The lasers of one firing of a VLP-16 look up to 0.13 degrees apart, so that a firing straddles
// two columns as narrow. Flat ground is ground all the same.
TEST(FeatureImage, FindsTheNextRingInTheColumnBeside) {
  test::Scene plain;
  plain.planes = {{{0.0, 0.0, 1.0}, -1.5}};
  Scan scan = test::still_scan_of(plain, k16, {});
  for (Return& r : scan.returns) {
    const double turn_rad = -2.0 * std::numbers::pi / 1800.0 * (r.ring * 5 % 16) / 16.0;
    const double x_m = static_cast<double>(r.x_m), y_m = static_cast<double>(r.y_m);
    r.x_m = static_cast<float>(std::cos(turn_rad) * x_m - std::sin(turn_rad) * y_m);
    r.y_m = static_cast<float>(std::sin(turn_rad) * x_m + std::cos(turn_rad) * y_m);
    r.azimuth_rad = std::atan2(r.y_m, r.x_m);
  }
  for (const int columns : {720, 1024, 1800, 2048}) {
    core::FeatureImage image(columns, {});
    int all = 0, wrong = 0;
    for (const Feature& f : image.build(scan)) {
      if (f.ring == 7) continue;  // meets the ground 86 m off, three times as far as the next
      ++all;
      if (f.kind != FeatureKind::ground) ++wrong;
    }
    EXPECT_GT(all, 5 * columns) << columns;  // of seven rings
    EXPECT_LE(wrong, 7) << columns << ": more than a column of " << all;
  }
}

// Floor and a wall, where one ring meets the floor just before the wall and the next one the wall
// just above the floor: by their slope alone the two might lie on a ramp.
TEST(FeatureImage, MakesNoRampOfFloorAndWall) {
  test::Scene hall;
  hall.planes = {{{0.0, 0.0, 1.0}, -0.8}, {{-1.0, 0.0, 0.0}, -9.6}, {{1.0, 0.0, 0.0}, -3.05}};
  core::FeatureImage image(1024, {});
  int ground = 0;
  for (const Feature& f : image.build(test::still_scan_of(hall, k16, {}))) {
    if (f.kind != FeatureKind::ground || is_overhead(f)) continue;
    const Eigen::Vector3d p = key_of(f), reach = gap_of(f);
    EXPECT_NEAR(p.z(), -0.8, 1e-3) << int{f.ring};
    const bool along_floor = std::abs(reach.z()) < 1e-3;
    const bool nobody_knows = std::abs(reach.normalized().dot(p.normalized())) < 1e-3;
    EXPECT_TRUE(along_floor || nobody_knows) << int{f.ring} << " " << p.transpose();
    ++ground;
  }
  EXPECT_GT(ground, 4000);
}

// Twigs 20 m away: one in every column, in two rings by turns.
TEST(FeatureImage, TakesNothingAboveTheHorizonFromTheColumnBeside) {
  constexpr int kColumns = 360;
  Scan scan;
  scan.beams = k16;
  scan.end_ns = 100'000'000;
  for (int column = 0; column < kColumns; ++column) {
    const auto ring = static_cast<std::uint8_t>(11 + column % 2);
    scan.returns.push_back(return_at(k16, ring, azimuth_of(column, kColumns), 20.0));
  }
  core::FeatureImage image(kColumns, {});
  const std::vector<Feature>& features = image.build(scan);
  ASSERT_EQ(features.size(), kColumns);
  for (const Feature& f : features) {
    EXPECT_EQ(f.kind, FeatureKind::structure);
    EXPECT_NEAR(f.dz_m, 20.0 * 2.0 * std::numbers::pi / 180.0, 1e-3);  // nobody knows
  }
}

// A ceiling 1.2 m above the sensor in front of it, and behind it twigs: every higher ring meets
// them a metre farther away, as nothing level overhead can be met.
TEST(FeatureImage, TakesCeilingsAndNoCanopyOverhead) {
  constexpr int kColumns = 360;
  constexpr double kHeight_m = 1.2;
  Scan scan;
  scan.beams = k16;
  scan.end_ns = 100'000'000;
  for (int column = 0; column < kColumns; ++column) {
    const double azimuth_rad = azimuth_of(column, kColumns);
    for (std::uint8_t ring = 11; ring < 16; ++ring) {
      const double up = std::tan(static_cast<double>(k16.elevation_rad[ring]));
      const double flat_m = std::abs(azimuth_rad) < 1.5 ? kHeight_m / up : 8.0 + (ring - 11);
      scan.returns.push_back(return_at(k16, ring, azimuth_rad, flat_m));
    }
  }
  core::FeatureImage image(kColumns, {});
  int overhead = 0;
  for (const Feature& f : image.build(scan)) {
    if (!is_overhead(f)) continue;
    ++overhead;
    EXPECT_NEAR(f.z_m, kHeight_m, 1e-3);
    EXPECT_NEAR(f.dz_m, 0.0, 1e-3);
  }
  EXPECT_GT(overhead, 400);
}

// Ground that the upper ring sees in one direction only. However late that return comes, the
// columns beside it have used it.
TEST(FeatureImage, WaitsForTheColumnBeside) {
  constexpr int kColumns = 360;
  const BeamTable beams = test::even_beams(2, -15.0, -13.0);
  const auto ground = [&](int column, std::uint8_t ring) {
    const double flat_m = 1.5 / std::tan(static_cast<double>(-beams.elevation_rad[ring]));
    return return_at(beams, ring, azimuth_of(column, kColumns), flat_m);
  };
  for (int seen = 60; seen <= 100; ++seen) {
    Scan scan;
    scan.beams = beams;
    scan.end_ns = 100'000'000;
    for (int column = 0; column < kColumns; ++column) {
      if (column == 101) scan.returns.push_back(ground(seen, 1));
      scan.returns.push_back(ground(column, 0));
    }
    core::FeatureImage image(kColumns, {});
    image.begin(beams);
    image.add(std::span(scan.returns).first(101));
    image.add(std::span(scan.returns).subspan(101));
    std::vector<int> beside;  // columns, from the one with the return
    for (const Feature& f : image.finish(scan)) {
      if (f.kind != FeatureKind::ground || f.ring == 1) continue;
      const double azimuth = std::atan2(static_cast<double>(f.y_m), static_cast<double>(f.x_m));
      const double column = (1.0 - azimuth / std::numbers::pi) * kColumns / 2.0;
      beside.push_back(static_cast<int>(column) - seen);
    }
    EXPECT_EQ(beside, (std::vector{-1, 0, 1})) << "seen in column " << seen;
  }
}

TEST(FeatureImage, FeaturesHaveTheirColumn) {
  constexpr int kColumns = 2048;
  core::FeatureImage image(kColumns, {});
  for (const Feature& f : image.build(test::still_scan_of(test::yard(), k16, {}))) {
    const double azimuth_rad = std::atan2(static_cast<double>(f.y_m), static_cast<double>(f.x_m));
    const double off_rad = azimuth_rad - azimuth_of(f.column, kColumns);
    ASSERT_LT(std::abs(std::remainder(off_rad, 2.0 * std::numbers::pi)), 0.0017) << f.column;
  }
}

// Against a loop over them one by one; with 64 rings there are more returns than pixels.
TEST(FeatureImage, APixelKeepsItsFirstGoodReturn) {
  std::mt19937 rng(1);
  const auto below = [&rng](unsigned n) { return static_cast<int>(rng() % n); };
  for (const int rings : {16, 64}) {
    const BeamTable beams = test::even_beams(rings, -15.0, 15.0);
    const int columns = core::FeatureImage::columns_for(rings, 1024);
    Scan all, good;
    for (Scan* scan : {&all, &good}) {
      scan->beams = beams;
      scan->end_ns = 100'000'000;
    }
    std::set<std::pair<int, int>> taken;
    for (int k = 0; k < 3 * rings * columns; ++k) {
      const int column = below(static_cast<unsigned>(columns));
      const bool is_near = below(5) == 0, is_none = below(5) == 0, is_foreign = below(5) == 0;
      Return r =
          return_at(beams, static_cast<std::uint8_t>(below(static_cast<unsigned>(rings))),
                    azimuth_of(column, columns), is_near ? 0.5 : 35.0 + below(40));  // no drops
      r.t_ns = k;
      if (is_none) r.x_m = std::numeric_limits<float>::quiet_NaN();
      if (is_foreign)
        r.ring = static_cast<std::uint8_t>(rings + below(256U - static_cast<unsigned>(rings)));
      all.returns.push_back(r);
      if (is_near || is_none || is_foreign) continue;
      if (taken.emplace(r.ring, column).second) good.returns.push_back(r);
    }
    core::FeatureImage image(1024, {}), expected_image(1024, {});
    const auto& found = image.build(all);
    const auto& expected = expected_image.build(good);
    EXPECT_GT(expected.size(), good.returns.size() / 2);
    ASSERT_EQ(found.size(), expected.size()) << rings << " rings";
    for (std::size_t k = 0; k < found.size(); ++k) {
      ASSERT_EQ(key_of(found[k]), key_of(expected[k])) << rings << " rings, feature " << k;
      ASSERT_EQ(found[k].s, expected[k].s);
    }
  }
}

}  // namespace
}  // namespace lilo
