// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/comparison.hpp"

namespace lilo::core {

bool fits_as_well(const Solution& one, const Solution& other) {
  constexpr double kAsWell = 0.95;
  return one.structure_inliers > kAsWell * other.structure_inliers;
}

bool tells_apart(const Solution& one, const Solution& other) {
  constexpr double kMuch = 20.0;
  const Eigen::Vector3d apart_m =
      one.trajectory.end().translation_m - other.trajectory.end().translation_m;
  const auto along = [&](const Matrix6d& information) {
    return apart_m.dot(information.bottomRightCorner<3, 3>() * apart_m);
  };
  return along(other.data_information) > kMuch * along(other.motion_information);
}

}  // namespace lilo::core
