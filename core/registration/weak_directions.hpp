// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/estimate.hpp"

#include <array>

namespace lilo::core {

struct WeakDirections {
  std::array<WeakDirection, kMaxWeakDirections> all{};
  int count = 0;  ///< the weakest first
};

/// The directions of a pose's change on which a scan says less than its duration alone does: less
/// than is known of where the sensor gets in that time, had all before been known exactly.
///
/// Both informations are of rotation, then translation, about the sensor, along the odometry's axes
/// (1/rad^2, 1/m^2). The generalised eigenvalues of the scan's against the motion's have no unit
/// and need no threshold set by hand: where one is below 1, every scan adds more doubt than it
/// takes, and drift along that direction goes unseen. Against the prediction itself one must not
/// compare: after a while in a tunnel it knows so little that any scan knows more.
/// Results are in the sensor's frame, translation first, as in Estimate. No allocation.
WeakDirections weak_directions(const Matrix6d& scan_information, const Matrix6d& motion_information,
                               const Eigen::Quaterniond& R_odom_sensor);

}  // namespace lilo::core
