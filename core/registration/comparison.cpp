// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/comparison.hpp"

#include "core/constants.hpp"

namespace lilo::core {

bool fits_as_well(const Solution& one, const Solution& other) {
  return one.structure_inliers > registration::kFitsAsWell * other.structure_inliers;
}

bool tells_apart(const Solution& one, const Solution& other) {
  const Eigen::Vector3d apart_m =
      one.trajectory.end().translation_m - other.trajectory.end().translation_m;
  const auto along = [&](const Matrix6d& information) {
    return apart_m.dot(information.bottomRightCorner<3, 3>() * apart_m);
  };
  return along(other.data_information) >
         registration::kTellsApart * along(other.motion_information);
}

}  // namespace lilo::core
