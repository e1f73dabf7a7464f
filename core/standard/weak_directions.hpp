#pragma once

#include "core/estimate.hpp"

#include <array>

namespace lilo::standard {

struct WeakDirections {
  std::array<WeakDirection, kMaxWeakDirections> all{};
  int count = 0;  ///< the weakest first
};

/// The directions of a pose's change on which the prediction knows more than the scan.
///
/// Both informations are of rotation, then translation, about the sensor, along the odometry's axes
/// (1/rad^2, 1/m^2). The generalised eigenvalues of the scan's against the prediction's have no
/// unit and need no threshold set by hand: where one is below 1, the answer is mostly prediction.
/// Results are in the sensor's frame, translation first, as in Estimate. No allocation.
WeakDirections weak_directions(const Matrix6d& scan_information,
                               const Matrix6d& prediction_information,
                               const Eigen::Quaterniond& R_odom_sensor);

}  // namespace lilo::standard
