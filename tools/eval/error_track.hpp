// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/csv.hpp"
#include "tools/eval/associate.hpp"

#include <vector>

namespace lilo {

/// How far off an estimate is at one instant. Estimate and truth are laid over each other at their
/// first common pose; both are told in the frame of that pose.
struct ErrorPoint {
  double distance_m = 0.0;  ///< true distance travelled since then
  Eigen::Vector3d estimate_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d truth_m = Eigen::Vector3d::Zero();
  double error_m = 0.0;    ///< between the two positions
  double error_deg = 0.0;  ///< angle between the two orientations
};

std::vector<ErrorPoint> error_track(const Matched& poses);

/// Columns distance_m, x_m, y_m, z_m, true_x_m, true_y_m, true_z_m, error_m, error_deg.
CsvTable error_table(const std::vector<ErrorPoint>& track);

}  // namespace lilo
