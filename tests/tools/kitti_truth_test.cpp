// SPDX-License-Identifier: BSD-3-Clause
#include "tools/kitti_truth.hpp"

#include "tests/tools/temporary_folder.hpp"
#include "tools/bench/benchmark_set.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace lilo {
namespace {

/// The camera looks along the sensor's x with its x to the right and y down, 0.5 m ahead.
constexpr const char* kCalibration =
    "P0: 7 0 6 0 0 7 1 0 0 0 1 0\n"
    "Tr: 0 -1 0 0  0 0 -1 0  1 0 0 -0.5\n";

/// Straight ahead 2 m, then a quarter turn to the left on the spot of the camera.
constexpr const char* kPoses =
    "1 0 0 0  0 1 0 0  0 0 1 0\n"
    "1 0 0 0  0 1 0 0  0 0 1 2\n"
    "0 0 -1 0  0 1 0 0  1 0 0 2\n";

TEST(KittiTruth, CameraPosesBecomeThoseOfTheSensor) {
  const TemporaryFolder folder;
  folder.write("sequences/04/calib.txt", kCalibration);
  folder.write("sequences/04/times.txt", "0\n1.037e-01\n0.25\n");
  folder.write("sequences/04/velodyne/000000.bin", "");
  folder.write("poses/04.txt", kPoses);
  const Trajectory truth = kitti_sequence_truth(folder.path() + "/sequences/04");
  ASSERT_EQ(truth.poses.size(), 3U);
  EXPECT_TRUE(truth.has_times);
  EXPECT_EQ(truth.poses[1].stamp_ns, 103'700'000);
  // Camera z is the sensor's x.
  EXPECT_LT((truth.poses[1].pose.translation_m - Eigen::Vector3d(2, 0, 0)).norm(), 1e-9);
  // The sensor is half a metre behind the camera: after the turn to its left it is to the right.
  EXPECT_LT((truth.poses[2].pose.translation_m - Eigen::Vector3d(2.5, -0.5, 0)).norm(), 1e-9);
  const Eigen::Vector3d ahead = truth.poses[2].pose.rotation * Eigen::Vector3d::UnitX();
  EXPECT_LT((ahead - Eigen::Vector3d::UnitY()).norm(), 1e-9);
}

TEST(KittiTruth, WithoutTimesScansAreATenthOfASecondApart) {
  const TemporaryFolder folder;
  folder.write("05/calib.txt", kCalibration);
  folder.write("05/poses.txt", kPoses);
  folder.write("05/velodyne/000001.bin", "");
  folder.write("05/velodyne/000002.bin", "");
  const Trajectory truth = kitti_sequence_truth(folder.path() + "/05");
  EXPECT_EQ(truth.poses[1].stamp_ns, 0);  // the first scan there is
  EXPECT_EQ(truth.poses[2].stamp_ns, 100'000'000);
}

TEST(KittiTruth, ACalibrationWithoutTrIsNamed) {
  const TemporaryFolder folder;
  folder.write("calib.txt", "P0: 1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_THROW((void)kitti_calibration(folder.path() + "/calib.txt", "Tr"), std::runtime_error);
}

/// One arc second of latitude is 30.92 m on a sphere of 6378137 m (R pi / 648000).
TEST(KittiTruth, RawDrivesGoByTheirGps) {
  const TemporaryFolder folder;
  const std::string day = "2011_09_26/";
  const std::string drive = day + "2011_09_26_drive_0001_sync/";
  folder.write(day + "calib_imu_to_velo.txt",
               "calib_time: 25-May-2012 16:47:16\nR: 1 0 0 0 1 0 0 0 1\nT: -1 0 0\n");
  folder.write(drive + "oxts/data/0000000000.txt", "49.0000000000 8.4 110 0 0 1.57079632679 0 0\n");
  folder.write(drive + "oxts/data/0000000001.txt", "49.0002777778 8.4 112 0 0 1.57079632679 0 0\n");
  folder.write(drive + "velodyne_points/data/0000000000.bin", "");
  const Trajectory truth = kitti_raw_truth(folder.path() + "/" + drive);
  ASSERT_EQ(truth.poses.size(), 2U);
  // North is straight ahead at a yaw of 90 degrees.
  const Eigen::Vector3d moved = truth.poses[1].pose.translation_m;
  EXPECT_NEAR(moved.x(), 6378137.0 * std::numbers::pi / 648000.0, 0.02);
  EXPECT_NEAR(moved.y(), 0.0, 1e-3);
  EXPECT_NEAR(moved.z(), 2.0, 1e-9);
  EXPECT_EQ(truth.poses[1].stamp_ns, 100'000'000);
  // With times in both, each keeps its own: the GPS unit's are not the scans'.
  folder.write(drive + "velodyne_points/timestamps.txt", "2011-09-26 13:02:25.95\n");
  folder.write(drive + "oxts/timestamps.txt",
               "2011-09-26 13:02:25.900000000\n2011-09-26 13:02:26.001000000\n");
  const Trajectory timed = kitti_raw_truth(folder.path() + "/" + drive);
  EXPECT_EQ(timed.poses[0].stamp_ns, 1'317'042'145'900'000'000);
  EXPECT_EQ(timed.poses[1].stamp_ns, 1'317'042'146'001'000'000);
}

TEST(BenchmarkSets, AreFoundInFoldersOfFolders) {
  const TemporaryFolder folder;
  folder.write("sim/park/data.pcap", "");
  folder.write("sim/park/gt_end.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
  folder.write("real/05/velodyne/000000.bin", "");
  folder.write("real/05/calib.txt", kCalibration);
  folder.write("real/05/poses.txt", kPoses);
  folder.write("notes/readme.txt", "");
  const auto sets = find_sets({folder.path()});
  ASSERT_EQ(sets.size(), 2U);
  EXPECT_EQ(sets[0].name, "05");
  EXPECT_EQ(sets[0].truth->poses.size(), 3U);
  EXPECT_EQ(sets[1].name, "park");
  EXPECT_TRUE(sets[1].input.ends_with("park/data.pcap"));
  EXPECT_EQ(sets[1].truth->poses.size(), 2U);
  EXPECT_THROW((void)find_sets({folder.path() + "/notes"}), std::runtime_error);
  EXPECT_THROW((void)find_sets({folder.path(), folder.path() + "/sim"}), std::runtime_error);
}

TEST(BenchmarkSets, OnesWithoutTruthAreRefusedWhereItIsNeeded) {
  const TemporaryFolder folder;
  folder.write("park/data.pcap", "");
  EXPECT_FALSE(find_sets({folder.path()})[0].truth.has_value());
  EXPECT_FALSE(find_sets({folder.path() + "/park/data.pcap"})[0].truth.has_value());
  EXPECT_THROW((void)find_sets_with_truth({folder.path()}), std::runtime_error);
}

}  // namespace
}  // namespace lilo
