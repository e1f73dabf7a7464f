// SPDX-License-Identifier: BSD-3-Clause
#include "core/paper/features.hpp"

#include "core/paper/segmentation.hpp"

// With these we link no library of filters; see local_map.cpp.
#include <pcl/filters/impl/filter.hpp>
#include <pcl/filters/impl/voxel_grid.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace lilo::paper {
namespace {

Point to_point(const Return& r, float per_ns) {
  Point p;
  p.x = r.x_m;
  p.y = r.y_m;
  p.z = r.z_m;
  p.intensity = static_cast<float>(r.t_ns) * per_ns;
  return p;
}

Point between(const Point& a, const Point& b, float weight) {
  Point p;
  p.getVector3fMap() = (1.0F - weight) * a.getVector3fMap() + weight * b.getVector3fMap();
  p.intensity = (1.0F - weight) * a.intensity + weight * b.intensity;
  return p;
}

/// Eqs. 14-16: the point at its height, moved to the middle of its column.
void move_to_centre(double azimuth_rad, float range_m, Point& p) {
  const float flat_m = std::sqrt(std::max(0.0F, range_m * range_m - p.z * p.z));
  p.x = flat_m * static_cast<float>(std::cos(azimuth_rad));
  p.y = flat_m * static_cast<float>(std::sin(azimuth_rad));
}

}  // namespace

Features reconstruct(const Scan& scan, const RangeImage& image, const cv::Mat1b& labels,
                     bool pixel_centres) {
  const auto duration_ns =
      static_cast<float>(std::max<std::int64_t>(scan.end_ns - scan.start_ns, 1));
  const float per_ns = 1.0F / duration_ns;
  Features features;
  for (int i = 0; i < image.rows(); ++i) {
    for (int j = 0; j < image.columns(); ++j) {
      const auto label = static_cast<Label>(labels(i, j));
      if (label == Label::empty) continue;
      const Pixel& pixel = image.at(i, j);
      Point p = to_point(scan.returns[static_cast<std::size_t>(pixel.first)], per_ns);
      if (pixel.second >= 0) {
        const Return& other = scan.returns[static_cast<std::size_t>(pixel.second)];
        p = between(p, to_point(other, per_ns), pixel.weight);
      }
      if (pixel_centres) {
        move_to_centre(column_azimuth_rad(j, image.columns()), image.range_m(i, j), p);
      }
      const auto& cloud = label == Label::edge      ? features.edges
                          : label == Label::surface ? features.surfaces
                                                    : features.ground;
      cloud->push_back(p);
    }
  }
  return features;
}

Cloud::Ptr voxel_grid(const Cloud::Ptr& cloud, double leaf_m) {
  Cloud::Ptr reduced(new Cloud);
  if (cloud->empty()) return reduced;
  pcl::VoxelGrid<Point> grid;
  const auto leaf = static_cast<float>(leaf_m);
  grid.setLeafSize(leaf, leaf, leaf);
  grid.setInputCloud(cloud);
  grid.filter(*reduced);
  return reduced;
}

void deskew(const Pose& T_start_end, const Cloud& raw, Cloud& deskewed) {
  // Points of one of 64 slices of the turn share a motion: 1/64 of the scan is 1.6 ms, half of
  // which is 2 cm at 25 m/s at most 1 cm off its slice's centre.
  constexpr int kSlices = 64;
  std::array<Eigen::Isometry3f, kSlices> T_end_slice;
  const Pose T_end_start = T_start_end.inverse();
  for (int k = 0; k < kSlices; ++k) {
    const double s = (k + 0.5) / kSlices;
    const Pose T = T_end_start * scale_motion(T_start_end, s);
    auto& slice = T_end_slice[static_cast<std::size_t>(k)];
    slice.setIdentity();
    slice.linear() = T.rotation.toRotationMatrix().cast<float>();
    slice.translation() = T.translation_m.cast<float>();
  }
  deskewed.resize(raw.size());
  for (std::size_t n = 0; n < raw.size(); ++n) {
    const float s = std::clamp(raw[n].intensity, 0.0F, 0.9999F);
    const auto k = static_cast<std::size_t>(s * kSlices);
    deskewed[n] = raw[n];
    deskewed[n].getVector3fMap() = T_end_slice[k] * raw[n].getVector3fMap();
  }
}

}  // namespace lilo::paper
