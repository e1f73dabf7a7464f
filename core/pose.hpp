// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

/// Rigid motions. `T_a_b` takes coordinates in frame b to coordinates in frame a.
/// Rotations are unit quaternions, normalised after every product: Eigen's Transform does not
/// re-orthonormalise and drifts to NaN over long runs.
namespace lilo {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// exp of so(3): rotation by |w| radians about w.
Eigen::Quaterniond so3_exp(const Eigen::Vector3d& w);

/// log of SO(3): |w| <= pi, so3_exp(so3_log(q)) == q up to sign.
Eigen::Vector3d so3_log(const Eigen::Quaterniond& q);

/// [v]x, so that [v]x u = v x u.
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();

  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& p) const {
    return rotation * p + translation_m;
  }
  [[nodiscard]] Pose operator*(const Pose& other) const;
  [[nodiscard]] Pose inverse() const;
};

/// Magnitude of a motion: the larger of its translation and of the way by which its rotation moves
/// a point at the distance motion::kLever_m.
[[nodiscard]] double magnitude_m(const Eigen::Vector3d& turned_rad, const Eigen::Vector3d& moved_m);
[[nodiscard]] double magnitude_m(const Pose& T);

/// The motion `s` of the way from identity to `T`, at constant linear velocity (in the parent
/// frame) and constant angular velocity. s may lie outside [0, 1].
Pose scale_motion(const Pose& T, double s);

/// The pose `s` of the way from `a` (s = 0) to `b` (s = 1).
Pose interpolate(const Pose& a, const Pose& b, double s);

}  // namespace lilo
