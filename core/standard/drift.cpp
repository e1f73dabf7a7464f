#include "core/standard/drift.hpp"

namespace lilo::standard {

void Drift::move(const Eigen::Vector3d& by_m) {
  Matrix6d F = Matrix6d::Identity();
  F.bottomLeftCorner<3, 3>() = -skew(by_m);  // rotation x by
  covariance_ = F * covariance_ * F.transpose();
}

void Drift::inherit(const Matrix6d& alignment) {
  // A part of the map is made of several keyframes, and what one of them errs is known in part to
  // those before. A rough figure: core/README.md says what comes of it.
  constexpr double kShare = 0.006;
  covariance_ += kShare * alignment;
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

}  // namespace lilo::standard
