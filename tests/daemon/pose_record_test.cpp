// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pose_record.hpp"

#include "daemon/map_file.hpp"

#include <gtest/gtest.h>

namespace lilo {
namespace {

Pose at_x(double x_m) { return {Eigen::Quaterniond::Identity(), {x_m, 0.0, 0.0}}; }

TEST(PoseRecord, KeepsTheLatestInOrder) {
  PoseRecord record(3);
  EXPECT_TRUE(record.copy().empty());
  for (int k = 0; k < 5; ++k) {
    record.add(k, at_x(k));
    const std::vector<RecordedPose> poses = record.copy();
    ASSERT_EQ(poses.size(), std::min<std::size_t>(3, static_cast<std::size_t>(k) + 1));
    for (std::size_t i = 0; i < poses.size(); ++i)
      EXPECT_EQ(poses[i].stamp_ns, k + 1 - static_cast<std::int64_t>(poses.size() - i));
    EXPECT_EQ(poses.back().position_m.x(), k);
  }
  EXPECT_EQ(record.forgotten(), 2U);
  record.clear();
  EXPECT_TRUE(record.copy().empty());
  EXPECT_EQ(record.forgotten(), 0U);
}

TEST(PoseRecord, MayHaveNoRoomAtAll) {
  PoseRecord record(0);
  record.add(1, at_x(1.0));
  EXPECT_TRUE(record.copy().empty());
}

TEST(Tum, IsEightNumbersALine) {
  PoseRecord record(2);
  const Pose pose{Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5), {1.25, -2.5, 0.0}};
  record.add(1'715'678'102'000'457'001, pose);
  EXPECT_EQ(to_tum(record.copy(), "a drive"),
            "# a drive\n# t x y z qx qy qz qw\n1715678102.000457001 1.250000 -2.500000 0.000000 "
            "-0.50000000 0.50000000 0.50000000 0.50000000\n");
}

}  // namespace
}  // namespace lilo
