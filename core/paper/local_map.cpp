// SPDX-License-Identifier: BSD-3-Clause
#include "core/paper/local_map.hpp"

// With these we link no library of filters, which brings five more and 10 MB of resident memory.
#include <pcl/filters/impl/crop_box.hpp>
#include <pcl/filters/impl/filter.hpp>
#include <pcl/filters/impl/filter_indices.hpp>

namespace lilo::paper {

void LocalMap::update(const std::vector<const Cloud*>& clouds, const Pose& T_odom_sensor) {
  Eigen::Isometry3f T = Eigen::Isometry3f::Identity();
  T.linear() = T_odom_sensor.rotation.toRotationMatrix().cast<float>();
  T.translation() = T_odom_sensor.translation_m.cast<float>();
  for (const Cloud* added : clouds) {
    for (Point p : *added) {
      p.getVector3fMap() = T * p.getVector3fMap();
      cloud_->push_back(p);
    }
  }
  pcl::CropBox<Point> crop;
  const auto half = static_cast<float>(radius_m_);
  const Eigen::Vector3f center = T.translation();
  crop.setMin({center.x() - half, center.y() - half, center.z() - half, 1.0F});
  crop.setMax({center.x() + half, center.y() + half, center.z() + half, 1.0F});
  crop.setInputCloud(cloud_);
  Cloud::Ptr cropped(new Cloud);
  crop.filter(*cropped);
  cloud_ = voxel_grid(cropped, voxel_m_);
  if (!cloud_->empty()) tree_.setInputCloud(cloud_);
}

const std::vector<int>& LocalMap::neighbours(const Point& point, double radius_m) const {
  indices_.clear();
  if (!cloud_->empty()) tree_.radiusSearch(point, radius_m, indices_, squared_distances_);
  return indices_;
}

}  // namespace lilo::paper
