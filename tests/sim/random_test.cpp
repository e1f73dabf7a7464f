// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace lilo::sim {
namespace {

TEST(Random, SineAndCosineAgreeWithTheLibrary) {
  for (int k = -20000; k <= 20000; ++k) {
    const double x = k * 0.0137;
    const SinCos ours = sin_cos(x);
    EXPECT_NEAR(ours.sin, std::sin(x), 1e-13);
    EXPECT_NEAR(ours.cos, std::cos(x), 1e-13);
    EXPECT_NEAR(ours.sin * ours.sin + ours.cos * ours.cos, 1.0, 1e-15) << x;
  }
}

TEST(Random, NormalHasUnitMoments) {
  Random random(3);
  constexpr int kCount = 200000;
  double sum = 0.0, squares = 0.0, fourth = 0.0;
  for (int k = 0; k < kCount; ++k) {
    const double v = random.normal();
    sum += v;
    squares += v * v;
    fourth += v * v * v * v;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.01);
  EXPECT_NEAR(squares / kCount, 1.0, 0.015);
  EXPECT_NEAR(fourth / kCount, 2.9, 0.08);  // twelve uniforms: 3 - 1.2 / 12
}

// The first outputs of the published SplitMix64 for the state 1234567.
TEST(Random, MixIsSplitMix64) {
  constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ULL;
  EXPECT_EQ(Random::mix(1234567 + kGolden), 6457827717110365317ULL);
  EXPECT_EQ(Random::mix(1234567 + 2 * kGolden), 3203168211198807973ULL);
}

TEST(Random, StreamsOfASeedDiffer) {
  Random a(7, 1), b(7, 2), c(7, 1);
  int equal = 0;
  for (int k = 0; k < 100; ++k) {
    const std::uint64_t value = a.next();
    equal += value == b.next() ? 1 : 0;
    EXPECT_EQ(value, c.next());
  }
  EXPECT_EQ(equal, 0);
}

}  // namespace
}  // namespace lilo::sim
