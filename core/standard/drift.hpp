#pragma once

#include "core/pose.hpp"

namespace lilo::standard {

/// What the local map has drifted since it was begun, as far as can be told: covariance of the pose
/// that an alignment without any error of its own would give.
///
/// Every keyframe builds a part of the map with the error of its own alignment, and that part hands
/// it on to what is aligned with it later. An error of attitude moves everything ahead of it aside.
/// All covariances: rotation then translation, as a small motion from the left about the sensor, in
/// the odometry's axes (rad, m).
class Drift {
 public:
  /// A map is begun by a sensor whose pose is that uncertain.
  void begin(const Matrix6d& at_start) { covariance_ = at_start_ = at_start; }

  /// The map in force is begun once more.
  void rewind() { covariance_ = at_start_; }

  /// The sensor has moved on: attitude errors made before turn into errors of position.
  void move(const Eigen::Vector3d& by_m);

  /// A keyframe aligned with this covariance becomes part of a map of so many.
  void inherit(const Matrix6d& alignment, int keyframes);

  [[nodiscard]] const Matrix6d& covariance() const { return covariance_; }

 private:
  Matrix6d covariance_ = Matrix6d::Zero();
  Matrix6d at_start_ = Matrix6d::Zero();
};

/// From the odometry's axes to the sensor's, order kept.
Matrix6d in_sensor_axes(const Matrix6d& covariance, const Eigen::Quaterniond& R_odom_sensor);

/// From (rotation, translation) to (translation, rotation): x y z rx ry rz.
Matrix6d translation_first(const Matrix6d& covariance);

}  // namespace lilo::standard
