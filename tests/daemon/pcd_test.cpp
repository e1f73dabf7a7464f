// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/map_file.hpp"

#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>

#include <cmath>
#include <cstdio>
#include <fstream>

namespace lilo {
namespace {

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
