// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/map_file.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>

namespace lilo {

std::string to_pcd(const std::vector<Eigen::Vector3f>& points_m, const Pose& T) {
  static_assert(std::endian::native == std::endian::little, "PCD is little-endian");
  constexpr std::size_t kPointBytes = 3 * sizeof(float);
  std::string file = fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\n"
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
      "WIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA binary\n",
      points_m.size());
  std::size_t at = file.size();
  file.resize(at + points_m.size() * kPointBytes);
  const Eigen::Matrix3d R = T.rotation.toRotationMatrix();
  for (const Eigen::Vector3f& point : points_m) {
    const Eigen::Vector3f moved = (R * point.cast<double>() + T.translation_m).cast<float>();
    std::memcpy(file.data() + at, moved.data(), kPointBytes);
    at += kPointBytes;
  }
  return file;
}

}  // namespace lilo
