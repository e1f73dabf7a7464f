// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/pose.hpp"

#include <Eigen/Core>

#include <cmath>
#include <vector>

/// What the searches for the initial motion, for a false motion and for a lost place share: a
/// displacement in the ground plane is supposed, scored on a grid seen from above, and taken when
/// its score is significantly better than that of the others.
namespace lilo::core {

/// A supposed motion besides a known one: along the ground and about the vertical, in the
/// odometry's axes. Where it is searched over time, of one second.
struct Displacement {
  Eigen::Vector2d along_m = Eigen::Vector2d::Zero();
  double yaw_rad = 0.0;        ///< of the last firing
  double begin_yaw_rad = 0.0;  ///< of the first; in between it changes evenly
};

/// `score` counts what agrees: returns that fall on the map, or cells that scans have in common.
struct Hypothesis {
  Displacement by;
  int score = 0;
};
inline bool has_lower_score(const Hypothesis& a, const Hypothesis& b) { return a.score < b.score; }

/// Whether one count is larger than another by more than chance brings: the difference of two
/// counts has the variance of their sum (Poisson).
inline bool is_significant(double count, double other, double sigmas) {
  return count - other > sigmas * std::sqrt(count + other);
}

/// The pose moved along the ground, and turned about the vertical through the sensor.
inline Pose displaced(const Pose& T, const Displacement& by) {
  return {(so3_exp({0.0, 0.0, by.yaw_rad}) * T.rotation).normalized(),
          T.translation_m + Eigen::Vector3d(by.along_m.x(), by.along_m.y(), 0.0)};
}

}  // namespace lilo::core
