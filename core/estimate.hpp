// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/pose.hpp"

#include <array>
#include <cstdint>

namespace lilo {

/// How far a pose may be trusted.
enum class TrackingStatus : std::uint8_t {
  initializing,  ///< no map yet, or not yet sure of the first motion
  tracking,      ///< aligned with the map
  degraded,      ///< aligned, but the prediction held some direction, data were missing, at most
                 ///< half of the usual structure fits, the solver did not converge, the last
                 ///< scans leave the motion in doubt, the pose is uncertain against the one 10 m
                 ///< before, or too few good alignments came in a row
  lost,          ///< not aligned: the pose is the prediction; or it was just found to be wrong
};

/// Velocity of the sensor, in the sensor's own frame.
struct Twist {
  Eigen::Vector3d linear_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_radps = Eigen::Vector3d::Zero();
};

/// A direction of motion of which the scan said too little: there the pose is mostly prediction.
/// It is told for the trajectory of the scan. The rotation that is reported may follow the
/// prediction more than that (core/registration/reported_end.hpp).
struct WeakDirection {
  /// Unit vector, order x y z rx ry rz (m and rad, as in `covariance`), in the sensor's frame.
  Vector6d direction = Vector6d::Zero();
  /// Part of the information along it that came from the scan, the rest being the motion model's
  /// over the scan; of scans shorter than 0.09 s both count over that time. 0: the prediction
  /// alone; 1: the scan alone.
  double from_scan = 0.0;
};
inline constexpr int kMaxWeakDirections = 6;

/// The result of the odometry for one scan.
struct Estimate {
  std::uint64_t scan_index = 0;
  std::int64_t stamp_ns = 0;  ///< the instant the pose describes: the scan's last firing
  Pose T_odom_sensor;         ///< identity at the first scan
  Twist twist;
  TrackingStatus status = TrackingStatus::initializing;
  /// Covariance of the pose since the first scan: x y z rx ry rz (m, rad), in the sensor's frame.
  /// It grows with the way travelled. core/README.md says how far it can be trusted.
  /// Valid only where has_covariance is set.
  Matrix6d covariance = Matrix6d::Zero();
  bool has_covariance = false;
  /// The first `weak_count` are valid, the weakest first. With one or more, the status is not
  /// `tracking`.
  std::array<WeakDirection, kMaxWeakDirections> weak_directions{};
  int weak_count = 0;
  /// Two motions fit the last scans, as between two lanes of traffic, or what is taller than
  /// vehicles moves away from its place in the map: status `degraded`.
  bool is_motion_doubtful = false;
  /// The pose may be off by more than 1 m or 3 degrees (2 sigma) against the one 10 m before in the
  /// same session, or 300 scans before if it moved less. Then the status is not `tracking`.
  bool is_uncertain = false;
  /// Good alignments followed each other (core::Confirmation). Else the status is not `tracking`.
  bool is_confirmed = true;

  /// How often a new session began: the map was given up, and another one begun where the
  /// prediction ended. Only that prediction joins poses of different counts.
  std::uint32_t restarts = 0;

  int ground_count = 0;                   ///< features used
  int structure_count = 0;                ///< features used (profile default)
  int edge_count = 0, surface_count = 0;  ///< features used (profile paper)
  int map_cell_count = 0;  ///< in the local map before the scan, of all sizes (default)
  int map_edge_count = 0, map_surface_count = 0;  ///< points in the local map (paper)
  /// Points left out since the odometry began: they needed a new cell of a map that was full.
  std::uint64_t map_refused_count = 0;
  int correspondence_count = 0;     ///< residuals of the last iteration
  int iterations = 0;               ///< Gauss-Newton steps taken
  double residual_rms_m = 0.0;      ///< of the last iteration (profile paper)
  double residual_rms_sigma = 0.0;  ///< the same in units of what the map expects (default)
};

}  // namespace lilo
