// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

/// How poses and points of the map depend on the errors of the beams.
namespace lilo::core {

/// Cosine and sine of the eccentricity, and the common error of the elevations (BeamCorrection).
inline constexpr int kBeamErrors = 3;
/// A column for each error, per radian. The last one (m) is what the corrections have done that
/// were applied so far: what is left without them depends on no earlier estimate.
inline constexpr int kBeamColumns = kBeamErrors + 1;

/// How a point moves (m). A row is one register of the processor.
using Sensitivity = Eigen::Matrix<float, 3, kBeamColumns, Eigen::RowMajor>;

using SensitivityRow = Eigen::Matrix<float, 1, kBeamColumns>;

/// How a pose moves: rotation, then translation (rows, odometry axes). The path that led there
/// moves with it nearly as a rigid body.
struct PoseSensitivity {
  using Matrix = Eigen::Matrix<float, 6, kBeamColumns, Eigen::RowMajor>;
  Matrix moved = Matrix::Zero();
  Eigen::Vector3d place_m = Eigen::Vector3d::Zero();  ///< of that pose, odometry frame

  /// How the same rigid motion moves a point.
  [[nodiscard]] Sensitivity at(const Eigen::Vector3d& point_m) const {
    const Eigen::Vector3f d = (point_m - place_m).cast<float>();
    Sensitivity point;  // rotation x d + translation
    point.row(0) = moved.row(1) * d.z() - moved.row(2) * d.y() + moved.row(3);
    point.row(1) = moved.row(2) * d.x() - moved.row(0) * d.z() + moved.row(4);
    point.row(2) = moved.row(0) * d.y() - moved.row(1) * d.x() + moved.row(5);
    return point;
  }
  /// The same rigid motion, expressed at another place.
  [[nodiscard]] PoseSensitivity expressed_at(const Eigen::Vector3d& other_m) const {
    PoseSensitivity same{moved, other_m};
    same.moved.bottomRows<3>() = at(other_m);
    return same;
  }
};

}  // namespace lilo::core
