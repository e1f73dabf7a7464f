// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/pose.hpp"

#include <Eigen/Core>

#include <cmath>
#include <vector>

/// Shared by the searches for the initial motion, for a false motion and for a lost place. Each
/// scores displacements in the ground plane on a top-down grid, and takes one whose score is
/// significantly better than that of the others.
namespace lilo::core {

/// A motion to be tested, added to a known one: along the ground and about the vertical, in the
/// odometry's axes. MotionSearch means the displacement in one second.
struct Displacement {
  Eigen::Vector2d along_m = Eigen::Vector2d::Zero();
  double yaw_rad = 0.0;        ///< of the last firing
  double begin_yaw_rad = 0.0;  ///< of the first; between the two it changes evenly
};

/// `score`: how many returns fall on the map, or how many cells the scans have in common.
struct Hypothesis {
  Displacement by;
  int score = 0;
};
inline bool has_lower_score(const Hypothesis& a, const Hypothesis& b) { return a.score < b.score; }

/// Whether one count is larger than another beyond chance. The difference of two counts has the
/// variance of their sum (Poisson).
inline bool is_significant(double count, double other, double sigmas) {
  return count - other > sigmas * std::sqrt(count + other);
}

/// The pose moved along the ground, and turned about the vertical through the sensor.
inline Pose displaced(const Pose& T, const Displacement& by) {
  return {(so3_exp({0.0, 0.0, by.yaw_rad}) * T.rotation).normalized(),
          T.translation_m + Eigen::Vector3d(by.along_m.x(), by.along_m.y(), 0.0)};
}

}  // namespace lilo::core
