// SPDX-License-Identifier: BSD-3-Clause
#include "core/tracking/tall_structure.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace lilo::core {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// Tall structure that places the sensor `off_m` away, with that standard deviation along x and y.
TallEquations places_it(const Eigen::Vector2d& off_m, double sigma_x_m, double sigma_y_m) {
  TallEquations tall{.is_slow = true};
  tall.information.diagonal() << 1.0 / (sigma_x_m * sigma_x_m), 1.0 / (sigma_y_m * sigma_y_m);
  tall.gradient = tall.information * off_m;
  return tall;
}

/// Twenty scans of 0.1 s from `begin_s` on.
void observe(TallStructure& structure, const TallEquations& scan, double begin_s,
             bool is_doubted = false) {
  for (int k = 0; k < 20; ++k) {
    structure.observe(scan, is_doubted,
                      static_cast<std::int64_t>((begin_s + 0.1 * k) * kSecond_ns));
  }
}

TEST(TallStructure, DisagreesWhereItIsSureOfAnotherPlace) {
  TallStructure structure;
  observe(structure, places_it({0.2, 0.0}, 0.1, 0.1), 0.0);
  EXPECT_TRUE(structure.disagrees()) << "two sigmas";
  structure.forget_scans();
  EXPECT_FALSE(structure.disagrees());
  observe(structure, places_it({0.2, 0.0}, 1.0, 0.01), 0.0);
  EXPECT_FALSE(structure.disagrees()) << "0.2 sigmas: a facade along the road";
  structure.forget_scans();
  observe(structure, places_it({0.02, 0.0}, 0.005, 0.005), 0.0);
  EXPECT_FALSE(structure.disagrees()) << "four sigmas, but 2 cm";
}

TEST(TallStructure, TwoScansAreNoDisagreement) {
  TallStructure structure;
  const TallEquations elsewhere = places_it({5.0, 0.0}, 0.01, 0.01);
  structure.observe(elsewhere, false, 0);
  structure.observe(elsewhere, false, kSecond_ns / 10);
  EXPECT_FALSE(structure.disagrees());
  structure.observe(elsewhere, false, 2 * kSecond_ns / 10);
  EXPECT_TRUE(structure.disagrees());
}

TEST(TallStructure, AScanThatTellsNoPlaceChangesNothing) {
  TallStructure structure;
  observe(structure, places_it({5.0, 0.0}, 0.01, 0.01), 0.0);
  ASSERT_TRUE(structure.disagrees());
  structure.observe(std::nullopt, false, 2 * kSecond_ns);
  EXPECT_TRUE(structure.disagrees());
  EXPECT_TRUE(structure.is_missing());
  structure.forget_scans();
  structure.observe(std::nullopt, false, 3 * kSecond_ns);
  EXPECT_FALSE(structure.disagrees());
  EXPECT_TRUE(structure.is_missing()) << "the doubt stays";
}

TEST(TallStructure, AScanThatTellsNoPlaceNeitherCountsNorInterrupts) {
  TallStructure structure;
  const TallEquations elsewhere = places_it({5.0, 0.0}, 0.01, 0.01);
  structure.observe(elsewhere, false, 0);
  structure.observe(elsewhere, false, kSecond_ns / 10);
  structure.observe(std::nullopt, false, 2 * kSecond_ns / 10);
  EXPECT_FALSE(structure.disagrees());
  structure.observe(elsewhere, false, 3 * kSecond_ns / 10);
  EXPECT_TRUE(structure.disagrees());
}

TEST(TallStructure, ADoubtIsNotRenewedByScansThatTellNoPlace) {
  TallStructure structure;
  observe(structure, places_it({5.0, 0.0}, 0.01, 0.01), 0.0);
  for (int k = 2; k < 40; ++k) structure.observe(std::nullopt, false, k * kSecond_ns);
  EXPECT_FALSE(structure.is_missing()) << "30 s are over";
}

TEST(TallStructure, TellsNoPlaceWhereAScanDidNotConverge) {
  Solution solution;
  solution.tall = places_it({0.0, 0.0}, 0.1, 0.1);
  solution.converged = true;
  EXPECT_TRUE(tall_equations(solution, /*is_lost=*/false, /*is_room=*/false)->is_slow);
  EXPECT_FALSE(tall_equations(solution, /*is_lost=*/false, /*is_room=*/true)->is_slow);
  EXPECT_FALSE(tall_equations(solution, /*is_lost=*/true, /*is_room=*/false)->is_slow);
  solution.converged = false;
  EXPECT_FALSE(tall_equations(solution, /*is_lost=*/false, /*is_room=*/false));
  solution.tall = {};
  EXPECT_TRUE(tall_equations(solution, /*is_lost=*/false, /*is_room=*/false)) << "a fast sensor";
}

TEST(TallStructure, KeepsNothingOfAFastSensor) {
  TallStructure structure;
  observe(structure, places_it({5.0, 0.0}, 0.01, 0.01), 0.0);
  EXPECT_TRUE(structure.disagrees());
  structure.observe(TallEquations{}, false, 2 * kSecond_ns);
  EXPECT_FALSE(structure.disagrees());
  EXPECT_FALSE(structure.is_missing());
  structure.observe(TallEquations{.is_slow = true}, false, 3 * kSecond_ns);
  EXPECT_TRUE(structure.is_missing()) << "the doubt stays";
}

TEST(TallStructure, IsMissingWhereItDoesNotConfirmADoubtedMotion) {
  const TallEquations hidden{.is_slow = true};
  TallStructure structure;
  observe(structure, hidden, 0.0);
  EXPECT_FALSE(structure.is_missing()) << "nothing made the motion doubtful";
  observe(structure, hidden, 2.0, /*is_doubted=*/true);
  observe(structure, hidden, 4.0);
  EXPECT_TRUE(structure.is_missing());
  observe(structure, places_it({0.0, 0.0}, 2.0, 0.01), 6.0);
  EXPECT_TRUE(structure.is_missing()) << "it tells nothing along the road";
  observe(structure, places_it({0.0, 0.0}, 0.05, 0.01), 8.0);
  EXPECT_FALSE(structure.is_missing());
  observe(structure, hidden, 10.0);
  EXPECT_TRUE(structure.is_missing()) << "a truck hides it again";
  observe(structure, hidden, 31.0);
  EXPECT_TRUE(structure.is_missing());
  observe(structure, hidden, 36.0);
  EXPECT_FALSE(structure.is_missing()) << "the jam was more than 30 s ago";
}

TEST(TallStructure, AClockThatIsSetBackEndsADoubt) {
  const TallEquations hidden{.is_slow = true};
  TallStructure structure;
  observe(structure, hidden, 100.0, /*is_doubted=*/true);
  EXPECT_TRUE(structure.is_missing());
  observe(structure, hidden, 50.0);
  EXPECT_FALSE(structure.is_missing());
  observe(structure, hidden, 100.0);
  EXPECT_FALSE(structure.is_missing()) << "the doubt is forgotten";
}

TEST(TallStructure, ForgetsScansButNoDoubt) {
  TallStructure structure;
  observe(structure, places_it({0.0, 0.0}, 0.05, 0.01), 0.0, /*is_doubted=*/true);
  structure.forget_scans();
  structure.observe(TallEquations{.is_slow = true}, false, 2 * kSecond_ns);
  EXPECT_TRUE(structure.is_missing()) << "the doubt stays, what was tall does not";
}

}  // namespace
}  // namespace lilo::core
