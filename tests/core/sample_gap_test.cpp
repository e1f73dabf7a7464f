// SPDX-License-Identifier: BSD-3-Clause
// How the ground goes on from ring to ring, against ground whose every range has a closed form.
#include "core/image/feature_image.hpp"
#include "tests/core/analytic_scene.hpp"
#include "tests/core/image_returns.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

namespace lilo {
namespace {

using test::gap_of;
using test::return_at;

const BeamTable k16 = test::even_beams(16, -15.0, 15.0);

/// By how many metres a beam falls in each metre of the way.
double falls(const BeamTable& beams, int ring) {
  return -std::tan(static_cast<double>(beams.elevation_rad[static_cast<std::size_t>(ring)]));
}

/// A plain so far below the sensor: where ring k meets it, and the features there.
struct Plain {
  explicit Plain(double down_m) : below_m(down_m) {
    test::Scene plain;
    plain.planes = {{{0.0, 0.0, 1.0}, -down_m}};
    core::FeatureImage image(1024, {});
    features = image.build(test::still_scan_of(plain, k16, {}));
  }
  [[nodiscard]] double away_m(int ring) const { return below_m / falls(k16, ring); }
  double below_m;
  std::vector<Feature> features;
};

// The next ring is the one below; of the lowest the one above.
TEST(SampleGap, TheGroundGoesOnToTheNearestRing) {
  const Plain plain(1.5);
  std::array<int, 8> count{};
  for (const Feature& f : plain.features) {
    if (f.ring == 7) continue;  // meets the ground 86 m off, three times as far as the next
    ASSERT_LT(f.ring, 7);
    ++count[f.ring];
    const Eigen::Vector2d away_m = Eigen::Vector2f(f.x_m, f.y_m).cast<double>();
    const int nearest = f.ring == 0 ? 1 : f.ring - 1;
    EXPECT_NEAR(away_m.normalized().dot(gap_of(f).head<2>()),
                plain.away_m(nearest) - plain.away_m(f.ring), 0.05)
        << int{f.ring};
    EXPECT_NEAR(f.dz_m, 0.0, 1e-3) << int{f.ring};
  }
  for (int ring = 0; ring < 7; ++ring) EXPECT_EQ(count[static_cast<std::size_t>(ring)], 1024);
}

// From 3 m above the ground, rings 5 and 6 meet it 23 m apart.
TEST(SampleGap, HowTheGroundGoesOnIsNotKnownBeyondTwentyMetres) {
  const Plain plain(3.0);
  int far = 0;
  for (const Feature& f : plain.features) {
    if (f.ring != 6) continue;
    EXPECT_NEAR(f.dz_m, plain.away_m(6) * 2.0 * std::numbers::pi / 180.0, 2e-3);
    ++far;
  }
  EXPECT_EQ(far, 1024);
}

struct Seen {
  int ring;
  double away_m;
};

/// The gap of the first of these rings.
std::optional<Eigen::Vector3d> gap_of_first(const BeamTable& beams, const std::vector<Seen>& seen) {
  Scan scan;
  scan.beams = beams;
  scan.end_ns = 100'000'000;
  for (const auto& [ring, away_m] : seen) {
    scan.returns.push_back(return_at(beams, static_cast<std::uint8_t>(ring), 0.001, away_m));
  }
  core::FeatureImage image(1024, {});
  for (const Feature& f : image.build(scan)) {
    if (f.ring == seen[0].ring) return gap_of(f);
  }
  return std::nullopt;
}

/// Expects the gap of the first ring along the tangent to ground of height b d^2 - 1.5 m, d away.
void expect_tangent(const BeamTable& beams, const std::array<int, 3>& rings, double b) {
  std::vector<Seen> seen;
  for (const int ring : rings) {
    const double f = falls(beams, ring);
    seen.push_back({ring, 3.0 / (f + std::sqrt(f * f + 6.0 * b))});
  }
  const double gap_m = seen[1].away_m - seen[0].away_m;
  ASSERT_GT(std::abs(gap_m), 10.0) << b;
  const auto gap = gap_of_first(beams, seen);
  ASSERT_TRUE(gap) << b;
  EXPECT_NEAR(gap->x(), gap_m, 1e-3) << b;
  EXPECT_NEAR(gap->z(), 2.0 * b * seen[0].away_m * gap_m, 1e-3) << b;
}

TEST(SampleGap, BetweenFarRingsTheGroundIsAParabola) {
  for (const double b : {-3e-4, -1e-4, 0.0, 1e-4}) expect_tangent(k16, {6, 5, 4}, b);
  // At 3, 2 and 1 degree below the horizon; nothing is seen of the rings below.
  for (const double b : {-1e-5, 0.0, 5e-5}) {
    expect_tangent(test::even_beams(16, -15.0, 0.0), {12, 13, 14}, b);
  }
}

TEST(SampleGap, HowRoughGroundGoesOnBetweenFarRingsIsNotKnown) {
  const std::vector<Seen> two{{6, 1.5 / falls(k16, 6)}, {5, 1.5 / falls(k16, 5)}};
  const auto is_known = [](const std::vector<Seen>& seen) {
    const auto gap = gap_of_first(k16, seen);
    EXPECT_TRUE(gap);
    return gap && std::abs(gap->z()) < 0.5;
  };
  const auto with_third = [&](double below_m) {
    return std::vector<Seen>{two[0], two[1], {4, below_m / falls(k16, 4)}};
  };
  EXPECT_TRUE(is_known(with_third(1.46))) << "the slope changes by 0.008";
  EXPECT_FALSE(is_known(with_third(1.42))) << "by 0.014";
  EXPECT_TRUE(is_known(with_third(1.54)));
  EXPECT_FALSE(is_known(with_third(1.57)));
  EXPECT_FALSE(is_known(two)) << "two rings";
}

}  // namespace
}  // namespace lilo
