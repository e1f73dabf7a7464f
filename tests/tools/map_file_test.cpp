// SPDX-License-Identifier: BSD-3-Clause
#include "tools/run/map_file.hpp"

#include "tests/tools/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace lilo {
namespace {

/// A wall at x = 5, 2 m by 2 m, a return every 2 cm.
Scan scan_of_wall() {
  Scan scan;
  scan.start_ns = 0;
  scan.end_ns = 100'000'000;
  for (int k = 0; k < 100; ++k) {
    for (int m = 0; m < 100; ++m)
      scan.returns.push_back({.x_m = 5.0F,
                              .y_m = 0.02F * static_cast<float>(k) + 0.01F,
                              .z_m = 0.02F * static_cast<float>(m) + 0.01F,
                              .intensity = 64});
  }
  return scan;
}

TEST(VoxelMap, KeepsOnePointAVoxel) {
  VoxelMap map(0.1);
  for (int k = 0; k < 5; ++k) map.add(scan_of_wall(), {});
  EXPECT_EQ(map.points().size(), 400U);
  EXPECT_EQ(map.voxel_m(), 0.1);
}

TEST(VoxelMap, GrowsItsVoxelsRatherThanItsMemory) {
  VoxelMap map(0.1, 300);
  map.add(scan_of_wall(), {});
  EXPECT_LE(map.points().size(), 300U);
  EXPECT_GT(map.points().size(), 100U);
  EXPECT_GT(map.voxel_m(), 0.1);
}

// As any reader of the format would: header, then the bytes of the first point.
TEST(MapFile, IsReadByItsHeader) {
  const TemporaryFolder folder;
  const std::vector<MapPoint> points{{{1.0F, 2.0F, 3.0F}, 7}, {{4.0F, 5.0F, 6.0F}, 255}};
  for (const std::string name : {"map.ply", "map.pcd"}) {
    const std::string path = folder.path() + "/" + name;
    write_map(path, points, MapColor::height);
    std::ostringstream bytes;
    bytes << std::ifstream(path, std::ios::binary).rdbuf();
    const std::string text = bytes.str();
    const bool ply = name == "map.ply";
    const std::string end = ply ? "end_header\n" : "DATA binary\n";
    const std::size_t data = text.find(end) + end.size();
    EXPECT_NE(text.find(ply ? "element vertex 2\n" : "POINTS 2\n"), std::string::npos);
    ASSERT_EQ(text.size() - data, 2U * (ply ? 16U : 20U)) << name;
    float second_x = 0.0F;
    std::memcpy(&second_x, text.data() + data + (ply ? 16 : 20), sizeof second_x);
    EXPECT_EQ(second_x, 4.0F);
  }
}

TEST(MapFile, KnowsItsNames) {
  EXPECT_TRUE(is_map_file("a/b.ply"));
  EXPECT_TRUE(is_map_file("b.pcd"));
  EXPECT_FALSE(is_map_file("b.png"));
  EXPECT_THROW(write_map("/no/such/folder/map.ply", {}, MapColor::height), std::runtime_error);
}

}  // namespace
}  // namespace lilo
