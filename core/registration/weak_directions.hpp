// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/estimate.hpp"

#include <array>

namespace lilo::core {

struct WeakDirections {
  std::array<WeakDirection, kMaxWeakDirections> all{};
  int count = 0;  ///< the weakest first
};

/// The directions along which a scan tells less of the pose than the motion model does: less than
/// would be known of the pose at its end, had the motion been known exactly until it began.
///
/// Both informations are of rotation, then translation, about the sensor, along the odometry's axes
/// (1/rad^2, 1/m^2). The generalised eigenvalues of the scan's information against that of the
/// motion have no unit, and the threshold 1 has a meaning: below it every scan adds more
/// uncertainty than it takes away, and drift along that direction goes unseen. The prediction
/// itself is no measure: after a while in a tunnel it is so uncertain that any scan tells more.
/// Results are in the sensor's frame, translation first, as in Estimate. No allocation.
WeakDirections weak_directions(const Matrix6d& scan_information, const Matrix6d& motion_information,
                               const Eigen::Quaterniond& R_odom_sensor);

}  // namespace lilo::core
