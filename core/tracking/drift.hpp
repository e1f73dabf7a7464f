// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/pose.hpp"
#include "core/tracking/recent_drift.hpp"

namespace lilo::core {

/// The drift of the local map since it was begun: the covariance of the pose that an alignment
/// without any error of its own would give. It begins with the error of the first scan's deskewing,
/// and grows in five ways:
///
/// - Every keyframe enters the map with the error of its own alignment and hands it on to the scans
///   that are aligned with it.
/// - A part of that error is correlated from keyframe to keyframe, since the same beams meet the
///   same surfaces. The correlation falls to 1/e over as many keyframes as a scan sees of the map.
///   In the sensor's axes it is a first-order Gauss-Markov process (Gelb, Applied Optimal
///   Estimation, 1974, chapter 3) that augments the pose.
/// - An error of attitude turns into an error of position as the sensor moves on.
/// - Along a direction of which scans tell next to nothing the motion is dead reckoned, also along
///   that of a degenerate scan, and along the ground where the odometry may have followed traffic.
/// - Errors of the beams that are not known bend the path.
///
/// The scale of the path is uncertain as well: what is seen of an object moves a little with the
/// sensor. All covariances: rotation then translation, as a small motion from the left about the
/// sensor, in the odometry's axes (rad, m).
class Drift {
 public:
  /// A map is begun; `at_start`: covariance of the pose there.
  void begin(const Matrix6d& at_start);

  /// The same map is begun once more.
  void rewind() { begin(at_start_); }

  /// The sensor moved: earlier errors of attitude turn into errors of position.
  void move(const Eigen::Vector3d& by_m);

  /// A keyframe with this covariance of its alignment, and this attitude of the sensor, enters a
  /// map of so many keyframes. `counts_as_recent`: for recent() as well.
  void inherit(const Matrix6d& alignment, const Eigen::Quaterniond& R_odom_sensor, int keyframes,
               bool counts_as_recent = true);

  /// Motions as columns (three weak ones and two along the ground), or zero; rotation then
  /// translation, in the odometry's axes: each with the square root of its process noise
  /// (rad/s^1.5, m/s^1.5). In a bend the sensor turns as it moves along.
  using Motions = Eigen::Matrix<double, 6, 5>;
  /// For `span_s` nothing was known of the motion along these but its process noise.
  /// `counts_as_recent`: for recent() as well.
  void coast(const Motions& motions, double span_s, bool counts_as_recent);
  /// For `span_s` a scan told of all translations.
  void see(double span_s);
  /// The covariance of the error with which the first scan entered the map, about the origin, where
  /// that scan ended. It replaces the last one; begin() and rewind() set it to zero.
  void set_first_scan(const Matrix6d& covariance) { of_first_scan_ = covariance; }
  /// The beams' part at the last pose (BeamCalibration::pose_covariance), until the next call.
  void set_beam_covariance(const Matrix6d& covariance) { of_beams_ = covariance; }

  [[nodiscard]] Matrix6d covariance() const;
  /// What it grew by over the last 10 m (RecentDrift), without what was left out, the path's
  /// scale, the beams and the first scan.
  [[nodiscard]] Matrix6d recent() const { return recent_.covariance(); }

 private:
  void grow(const Matrix6d& by, bool counts_as_recent);

  Matrix6d pose_ = Matrix6d::Zero();   // without the path's scale, the beams and the first scan
  Matrix6d cross_ = Matrix6d::Zero();  // covariance of the pose with the correlated error
  Matrix6d of_beams_ = Matrix6d::Zero();
  Matrix6d of_first_scan_ = Matrix6d::Zero();
  Eigen::Vector3d travelled_m_ = Eigen::Vector3d::Zero();  // since the map was begun
  Matrix6d at_start_ = Matrix6d::Zero();
  RecentDrift recent_;      // of pose_
  double coasted_s_ = 0.0;  // time of dead reckoning, less the time seen since
};

/// From the odometry's axes to the sensor's, order kept.
Matrix6d in_sensor_axes(const Matrix6d& covariance, const Eigen::Quaterniond& R_odom_sensor);

/// From (rotation, translation) to (translation, rotation): x y z rx ry rz.
Matrix6d translation_first(const Matrix6d& covariance);

}  // namespace lilo::core
