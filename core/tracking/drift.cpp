// SPDX-License-Identifier: BSD-3-Clause
#include "core/tracking/drift.hpp"

#include "core/constants.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace lilo::core {
namespace {

/// Takes a small motion about one place to the same motion about a place farther by `by_m`.
Matrix6d moved_by(const Eigen::Vector3d& by_m) {
  Matrix6d F = Matrix6d::Identity();
  F.bottomLeftCorner<3, 3>() = -skew(by_m);  // rotation x by
  return F;
}

}  // namespace

void Drift::begin(const Matrix6d& at_start) {
  pose_ = at_start_ = at_start;
  recent_.clear();
  cross_.setZero();
  of_beams_.setZero();
  of_first_scan_.setZero();
  travelled_m_.setZero();
  coasted_s_ = 0.0;
}

void Drift::move(const Eigen::Vector3d& by_m) {
  const Matrix6d F = moved_by(by_m);
  pose_ = F * pose_ * F.transpose();
  recent_.move(F, by_m.norm());
  of_beams_ = F * of_beams_ * F.transpose();
  cross_ = F * cross_;
  travelled_m_ += by_m;
}

void Drift::grow(const Matrix6d& by, bool counts_as_recent) {
  pose_ += by;
  if (counts_as_recent) recent_.grow(by);
}

void Drift::inherit(const Matrix6d& alignment, const Eigen::Quaterniond& R_odom_sensor,
                    int keyframes, bool counts_as_recent) {
  // An error of one keyframe moves what is seen of the map by its part in it, which is larger in a
  // young map.
  const double part = 1.0 / std::min(keyframes, tracking::kKeyframesInView);
  grow(part * part * alignment, counts_as_recent);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(alignment);
  if (eigen.info() != Eigen::Success || !(eigen.eigenvalues()[0] >= 0.0)) return;
  Matrix6d sensor_to_odom = Matrix6d::Zero();
  sensor_to_odom.topLeftCorner<3, 3>() = R_odom_sensor.toRotationMatrix();
  sensor_to_odom.bottomRightCorner<3, 3>() = sensor_to_odom.topLeftCorner<3, 3>();
  const Matrix6d gain = tracking::kCorrelatedError * part * eigen.operatorSqrt() * sensor_to_odom;
  cross_ *= std::exp(-1.0 / tracking::kKeyframesInView);
  const Matrix6d shared = gain * cross_.transpose();
  grow(shared + shared.transpose() + gain * gain.transpose(), counts_as_recent);
  cross_ += gain;
}

// White noise of density q makes a position uncertain by q t^3 / 3: by q t^2 dt more in a moment.
// The motions have the square root of q.
void Drift::coast(const Motions& motions, double span_s, bool counts_as_recent) {
  coasted_s_ += span_s;
  grow(coasted_s_ * coasted_s_ * span_s * motions * motions.transpose(), counts_as_recent);
}

// One scan that tells little more than nothing does not restore the velocity.
void Drift::see(double span_s) { coasted_s_ = std::max(0.0, coasted_s_ - span_s); }

Matrix6d Drift::covariance() const {
  const Matrix6d F = moved_by(travelled_m_);
  Matrix6d sum = pose_ + of_beams_ + F * of_first_scan_ * F.transpose();
  sum.bottomRightCorner<3, 3>() +=
      tracking::kPathScale * tracking::kPathScale * travelled_m_ * travelled_m_.transpose();
  return sum;
}

Matrix6d in_sensor_axes(const Matrix6d& covariance, const Eigen::Quaterniond& R_odom_sensor) {
  const Eigen::Matrix3d back = R_odom_sensor.conjugate().toRotationMatrix();
  Matrix6d A = Matrix6d::Zero();
  A.topLeftCorner<3, 3>() = back;
  A.bottomRightCorner<3, 3>() = back;
  return A * covariance * A.transpose();
}

Matrix6d translation_first(const Matrix6d& covariance) {
  Matrix6d swapped;
  swapped << covariance.bottomRightCorner<3, 3>(), covariance.bottomLeftCorner<3, 3>(),
      covariance.topRightCorner<3, 3>(), covariance.topLeftCorner<3, 3>();
  return swapped;
}

}  // namespace lilo::core
