// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/pose.hpp"

namespace lilo::core {

/// What the local map has drifted since it was begun, as far as can be told: covariance of the pose
/// that an alignment without any error of its own would give.
///
/// Every keyframe builds a part of the map with the error of its own alignment, and that part hands
/// it on to what is aligned with it later. A part of that error is the same every time, since the
/// same beams meet surfaces of the same kind under the same angles: it adds up along the way, as a
/// scale does, and comes back on a loop. An error of attitude moves everything ahead of it aside.
/// Where scans do not tell of a direction, the motion along it is dead reckoned. What is seen of
/// things moves a little with the sensor: the path's scale is wrong by a part of it.
/// All covariances: rotation then translation, as a small motion from the left about the sensor, in
/// the odometry's axes (rad, m).
class Drift {
 public:
  /// A map is begun by a sensor whose pose is that uncertain.
  void begin(const Matrix6d& at_start);

  /// The map in force is begun once more.
  void rewind() { begin(at_start_); }

  /// The sensor has moved on: attitude errors made before turn into errors of position.
  void move(const Eigen::Vector3d& by_m);

  /// A keyframe aligned with this covariance, by a sensor of this attitude, becomes part of a map
  /// of so many.
  void inherit(const Matrix6d& alignment, const Eigen::Quaterniond& R_odom_sensor, int keyframes);

  /// For `span_s` the scan told nothing of the motion along the columns of `axes` (unit vectors or
  /// zero, odometry's axes), but that its acceleration is white noise of that density (m^2/s^3).
  void coast(const Eigen::Matrix3d& axes, double acceleration_density, double span_s);
  /// For `span_s` it told of all translations.
  void see(double span_s);

  [[nodiscard]] Matrix6d covariance() const;

 private:
  Matrix6d random_ = Matrix6d::Zero();
  /// What a steady error of one sigma in each of the sensor's axes has come to.
  Matrix6d steady_ = Matrix6d::Zero();
  Eigen::Vector3d travelled_m_ = Eigen::Vector3d::Zero();  // since the map was begun
  Matrix6d at_start_ = Matrix6d::Zero();
  double coasted_s_ = 0.0;  // dead reckoned on end
};

/// From the odometry's axes to the sensor's, order kept.
Matrix6d in_sensor_axes(const Matrix6d& covariance, const Eigen::Quaterniond& R_odom_sensor);

/// From (rotation, translation) to (translation, rotation): x y z rx ry rz.
Matrix6d translation_first(const Matrix6d& covariance);

}  // namespace lilo::core
