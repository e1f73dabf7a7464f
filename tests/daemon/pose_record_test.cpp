#include "daemon/pose_record.hpp"

#include "daemon/map_file.hpp"

#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>

#include <fstream>
#include <sstream>

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

// PCL reads it, and finds the points where the pose puts them.
TEST(Pcd, IsReadByPcl) {
  const std::string path = testing::TempDir() + "lilo_map_test.pcd";
  const Pose quarter_turn{Eigen::Quaterniond(std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)),
                          {10.0, 0.0, 1.0}};
  std::ofstream(path, std::ios::binary)
      << to_pcd({{1.0F, 0.0F, 0.0F}, {0.0F, 2.0F, 0.5F}}, quarter_turn);
  pcl::PointCloud<pcl::PointXYZ> cloud;
  ASSERT_EQ(pcl::io::loadPCDFile(path, cloud), 0);
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_LT((cloud[0].getVector3fMap() - Eigen::Vector3f(10.0F, 1.0F, 1.0F)).norm(), 1e-5F);
  EXPECT_LT((cloud[1].getVector3fMap() - Eigen::Vector3f(8.0F, 0.0F, 1.5F)).norm(), 1e-5F);
  std::ofstream(path, std::ios::binary) << to_pcd({}, {});
  pcl::PCDReader reader;
  pcl::PCLPointCloud2 none;
  EXPECT_EQ(reader.readHeader(path, none), 0);
  EXPECT_EQ(none.width, 0U);
  std::remove(path.c_str());
}

}  // namespace
}  // namespace lilo
