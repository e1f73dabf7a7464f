#include "core/standard/drift.hpp"

#include <algorithm>

namespace lilo::standard {

void Drift::move(const Eigen::Vector3d& by_m) {
  Matrix6d F = Matrix6d::Identity();
  F.bottomLeftCorner<3, 3>() = -skew(by_m);  // rotation x by
  covariance_ = F * covariance_ * F.transpose();
}

void Drift::inherit(const Matrix6d& alignment, int keyframes) {
  // An error of one keyframe moves what is seen of the map by its part in it. That is about a
  // dozen, fewer in a young map; the first, which is aligned with nothing, stands for four. Rough
  // figures: core/README.md says what comes of them.
  constexpr int kSeenAtOnce = 13;
  const double part = 1.0 / std::min(keyframes + 3, kSeenAtOnce);
  covariance_ += part * part * alignment;
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
