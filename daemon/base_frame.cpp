// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/base_frame.hpp"

namespace lilo {
namespace {

// Of a small motion (x y z rx ry rz) seen in the sensor's frame to the same one in the base frame.
Matrix6d adjoint(const Pose& T_base_sensor) {
  const Eigen::Matrix3d R = T_base_sensor.rotation.toRotationMatrix();
  Matrix6d out = Matrix6d::Zero();
  out.topLeftCorner<3, 3>() = R;
  out.topRightCorner<3, 3>() = skew(T_base_sensor.translation_m) * R;
  out.bottomRightCorner<3, 3>() = R;
  return out;
}

}  // namespace

Pose to_pose(const MountConfig& m) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const Eigen::Quaterniond rotation = AngleAxisd(m.yaw_rad, Vector3d::UnitZ()) *
                                      AngleAxisd(m.pitch_rad, Vector3d::UnitY()) *
                                      AngleAxisd(m.roll_rad, Vector3d::UnitX());
  return {rotation.normalized(), {m.x_m, m.y_m, m.z_m}};
}

bool is_identity(const MountConfig& m) {
  return m.x_m == 0.0 && m.y_m == 0.0 && m.z_m == 0.0 && m.roll_rad == 0.0 && m.pitch_rad == 0.0 &&
         m.yaw_rad == 0.0;
}

Estimate in_base_frame(const Estimate& sensor, const Pose& T_base_sensor) {
  Estimate base = sensor;
  base.T_odom_sensor = T_base_sensor * sensor.T_odom_sensor * T_base_sensor.inverse();
  const Eigen::Vector3d angular = T_base_sensor.rotation * sensor.twist.angular_radps;
  base.twist.angular_radps = angular;
  // The base's origin lies at -t from the sensor, and turns about it.
  base.twist.linear_mps =
      T_base_sensor.rotation * sensor.twist.linear_mps - angular.cross(T_base_sensor.translation_m);
  const Matrix6d A = adjoint(T_base_sensor);
  base.covariance = A * sensor.covariance * A.transpose();
  for (WeakDirection& weak : base.weak_directions)
    weak.direction = (A * weak.direction).normalized();
  return base;
}

}  // namespace lilo
