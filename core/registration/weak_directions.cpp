// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/weak_directions.hpp"

#include "core/constants.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace lilo::core {

WeakDirections weak_directions(const Matrix6d& scan_information, const Matrix6d& motion_information,
                               const Eigen::Quaterniond& R_odom_sensor) {
  WeakDirections weak;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> solver(scan_information,
                                                                  motion_information);
  if (solver.info() != Eigen::Success) return weak;
  for (int k = 0; k < kMaxWeakDirections; ++k) {  // eigenvalues grow
    const double ratio = std::max(0.0, solver.eigenvalues()[k]);
    const double from_scan = ratio / (1.0 + ratio);
    if (!(from_scan < registration::kWeakShare)) break;
    const Vector6d along = solver.eigenvectors().col(k).normalized();
    WeakDirection& one = weak.all[static_cast<std::size_t>(weak.count++)];
    one.direction << R_odom_sensor.conjugate() * along.tail<3>(),
        R_odom_sensor.conjugate() * along.head<3>();
    one.from_scan = from_scan;
  }
  return weak;
}

}  // namespace lilo::core
