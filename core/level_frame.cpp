// SPDX-License-Identifier: BSD-3-Clause
#include "core/level_frame.hpp"

#include "core/pose.hpp"

namespace lilo {

Estimate in_sensor_axes(Estimate estimate, const Eigen::Quaterniond& R_level_sensor) {
  const Eigen::Quaterniond R_sensor_level = R_level_sensor.conjugate();
  const Eigen::Matrix3d turn = R_sensor_level.toRotationMatrix();
  Matrix6d both = Matrix6d::Zero();
  both.topLeftCorner<3, 3>() = both.bottomRightCorner<3, 3>() = turn;
  Pose& T = estimate.T_odom_sensor;
  T = {(R_sensor_level * T.rotation * R_level_sensor).normalized(), turn * T.translation_m};
  estimate.twist.linear_mps = turn * estimate.twist.linear_mps;
  estimate.twist.angular_radps = turn * estimate.twist.angular_radps;
  estimate.covariance = both * estimate.covariance * both.transpose();
  for (WeakDirection& weak : estimate.weak_directions) weak.direction = both * weak.direction;
  return estimate;
}

void turn_to_sensor_axes(const Eigen::Quaterniond& R_level_sensor,
                         std::vector<Eigen::Vector3f>& points_m) {
  const Eigen::Matrix3f turn = R_level_sensor.conjugate().toRotationMatrix().cast<float>();
  for (Eigen::Vector3f& p : points_m) p = turn * p;
}

}  // namespace lilo
