// SPDX-License-Identifier: BSD-3-Clause
// Six scans of posts, laid over each other as a stationary sensor and as a moving one saw them.
#include "core/search/tracked_scans.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <vector>

namespace lilo::core {
namespace {

constexpr int kPosts = 9;
constexpr double kScan_s = 0.1;

/// Posts on the left, 10 m apart, in the middle of a cell of the grid.
std::vector<Feature> posts() {
  std::vector<Feature> features;
  for (int k = 0; k < kPosts; ++k) {
    Feature post{};
    post.x_m = 10.0F * static_cast<float>(k) + 0.25F;
    post.y_m = 20.25F;
    post.s = 1.0F;
    post.kind = FeatureKind::structure;
    features.push_back(post);
  }
  return features;
}

class TrackedScansTest : public testing::Test {
 protected:
  TrackedScansTest() {
    StructurePoints structure;
    structure.reserve(kPosts);
    structure.assign(posts());
    for (int k = 0; k < static_cast<int>(search::kMotionScans); ++k) {
      const auto end_ns = static_cast<std::int64_t>(1e9 * kScan_s) * (k + 1);
      scans_.add(structure, {}, {}, {end_ns - static_cast<std::int64_t>(1e9 * kScan_s), end_ns});
    }
  }
  int occupied_under(double faster_mps, int limit) {
    return scans_.occupied_under({faster_mps, 0.0}, Subsample::all, grid_, limit);
  }

  static constexpr int kNoLimit = std::numeric_limits<int>::max();
  TrackedScans scans_{kPosts};
  TopDownGrid grid_{kPosts};
};

TEST_F(TrackedScansTest, UnderTheTrueMotionEveryScanSeesTheSameCells) {
  EXPECT_EQ(occupied_under(0.0, kNoLimit), kPosts);
}

// 10 m/s move a post by two cells from scan to scan.
TEST_F(TrackedScansTest, UnderAnotherMotionEveryScanHasCellsOfItsOwn) {
  EXPECT_EQ(occupied_under(10.0, kNoLimit), 6 * kPosts);
}

TEST_F(TrackedScansTest, GivesTheLimitWhereThereAreAsManyOrMore) {
  EXPECT_EQ(occupied_under(10.0, 6 * kPosts + 1), 6 * kPosts);
  for (const int limit : {1, kPosts, 2 * kPosts + 1, 6 * kPosts}) {
    EXPECT_EQ(occupied_under(10.0, limit), limit);
  }
  EXPECT_EQ(occupied_under(0.0, kPosts + 1), kPosts);
}

}  // namespace
}  // namespace lilo::core
