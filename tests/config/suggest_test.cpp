// SPDX-License-Identifier: BSD-3-Clause
#include "config/suggest.hpp"

#include <gtest/gtest.h>

namespace lilo {
namespace {

TEST(EditDistance, KnownDistances) {
  EXPECT_EQ(edit_distance("", ""), 0);
  EXPECT_EQ(edit_distance("abc", ""), 3);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("port", "prot"), 1) << "neighbours swapped";
  EXPECT_EQ(edit_distance("ca", "abc"), 3) << "optimal string alignment, not Damerau's 2";
}

TEST(Closest, PrefersTheSameSection) {
  const std::vector<std::string> known{"a", "b", "a.range", "b.range", "b.rate"};
  EXPECT_EQ(closest_path("b.rangee", known), "b.range");
  EXPECT_EQ(closest_path("a.rate", known), "b.rate");
  EXPECT_EQ(closest_path("a.colour", known), "");
}

}  // namespace
}  // namespace lilo
