// SPDX-License-Identifier: BSD-3-Clause
#include "tools/trajectory.hpp"

#include "tests/tools/temporary_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace lilo {
namespace {

std::string error_of(const std::string& path) {
  try {
    (void)read_trajectory(path);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Trajectory, TumColumnsAreTimePositionQuaternion) {
  const TemporaryFile file(
      "# t x y z qx qy qz qw\n"
      "\n"
      "1715678102.249522001 1 -2 3.5 0 0 0.70710678118 0.70710678118\n"
      "1715678102.349510 0 0 0 0 0 0 1\r\n");
  const Trajectory trajectory = read_trajectory(file.path());
  ASSERT_EQ(trajectory.poses.size(), 2U);
  EXPECT_TRUE(trajectory.has_times);
  EXPECT_EQ(trajectory.poses[0].stamp_ns, 1715678102249522001);
  EXPECT_EQ(trajectory.poses[1].stamp_ns, 1715678102349510000);
  EXPECT_EQ(trajectory.poses[0].pose.translation_m, Eigen::Vector3d(1, -2, 3.5));
  const Eigen::Vector3d turned = trajectory.poses[0].pose.rotation * Eigen::Vector3d::UnitX();
  EXPECT_LT((turned - Eigen::Vector3d::UnitY()).norm(), 1e-9);
}

TEST(Trajectory, KittiRowsAreTheMatrixRowByRow) {
  const TemporaryFile file("0 -1 0 4  1 0 0 5  0 0 1 6\n");
  const Trajectory trajectory = read_trajectory(file.path());
  ASSERT_EQ(trajectory.poses.size(), 1U);
  EXPECT_FALSE(trajectory.has_times);
  const Pose& pose = trajectory.poses[0].pose;
  EXPECT_EQ(pose.translation_m, Eigen::Vector3d(4, 5, 6));
  EXPECT_LT((pose.rotation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
}

TEST(Trajectory, WrittenFilesReadBackAsTheSamePoses) {
  std::vector<StampedPose> poses;
  poses.reserve(50);
  for (int k = 0; k < 50; ++k) {
    poses.push_back({1'700'000'000'000'000'000 + k * 99'999'999LL,
                     {so3_exp({0.1 * k, -0.05 * k, 0.02 * k}), {1.0 * k, -0.37 * k, 1e-3 * k}}});
  }
  const TemporaryFile tum, kitti;
  write_tum(tum.path(), poses);
  write_kitti(kitti.path(), poses);
  const Trajectory a = read_trajectory(tum.path()), b = read_trajectory(kitti.path());
  ASSERT_EQ(a.poses.size(), poses.size());
  ASSERT_EQ(b.poses.size(), poses.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    EXPECT_EQ(a.poses[k].stamp_ns, poses[k].stamp_ns);
    for (const Trajectory* read : {&a, &b}) {
      const Pose D = poses[k].pose.inverse() * read->poses[k].pose;
      EXPECT_LT(D.translation_m.norm(), 2e-9);
      EXPECT_LT(so3_log(D.rotation).norm(), 5e-9);
    }
  }
}

TEST(Trajectory, TumTimeKeepsNanosecondsBeforeTheEpochToo) {
  EXPECT_TRUE(tum_line({-1, {}}).starts_with("-0.000000001 0.000000000"));
  const TemporaryFile file(tum_line({-1'500'000'000, {}}) + "\n");
  EXPECT_EQ(read_trajectory(file.path()).poses[0].stamp_ns, -1'500'000'000);
}

TEST(Trajectory, DistanceTravelledGrowsByTheSteps) {
  const std::vector<Pose> poses = {
      {.translation_m = {0, 0, 0}}, {.translation_m = {3, 4, 0}}, {.translation_m = {3, 4, 2}}};
  EXPECT_EQ(travelled_m(poses), (std::vector<double>{0.0, 5.0, 7.0}));
}

TEST(Trajectory, ErrorsNameFileAndLine) {
  EXPECT_NE(error_of("/no/such/file").find("/no/such/file: cannot read: No such file"),
            std::string::npos);
  EXPECT_NE(error_of("/tmp").find("/tmp: expected a file, found a folder"), std::string::npos);
  const std::string good = "1 0 0 0 0 0 0 1\n";
  const struct {
    std::string text, line, what;
  } cases[] = {
      {"", "", "found none"},
      {"1 2 3\n", ":1:", "expected 8 (TUM) or 12 (KITTI) numbers, found 3"},
      {good + "2 0 0\n", ":2:", "expected 8 numbers, found 3"},
      {good + "2 0 0 x 0 0 0 1\n", ":2:", "expected a number in column 4, found 'x'"},
      {good + "2 0 0 nan 0 0 0 1\n", ":2:", "column 4"},
      {good + "# note\n1 0 0 0 0 0 0 1\n", ":3:", "later time"},
      {"1 0 0 0 0 0 0 0\n", ":1:", "unit quaternion"},
      {"1e300 0 0 0 0 0 0 1\n", ":1:", "seconds"},
      {"2 0 0 0  0 1 0 0  0 0 1 0\n", ":1:", "rotation matrix"},
      {"-1 0 0 0  0 1 0 0  0 0 1 0\n", ":1:", "rotation matrix"},
  };
  for (const auto& bad : cases) {
    const TemporaryFile file(bad.text);
    const std::string error = error_of(file.path());
    EXPECT_NE(error.find(file.path() + bad.line), std::string::npos) << error;
    EXPECT_NE(error.find(bad.what), std::string::npos) << error;
  }
  EXPECT_THROW(write_tum("/no/such/folder/poses.tum", {}), std::runtime_error);
}

}  // namespace
}  // namespace lilo
