// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/estimate.hpp"

#include <Eigen/Core>

#include <array>
#include <optional>

namespace lilo::core {

struct WeakDirections {
  std::array<WeakDirection, kMaxWeakDirections> all{};
  int count = 0;  ///< the weakest first
};

/// The directions along which a scan tells less of the pose than the motion model does: less than
/// would be known of the pose at its end, had the motion been known exactly until it began. Scans
/// shorter than motion::kComparedSpan_s are taken together: those of that span tell less than the
/// motion model over it.
///
/// Both informations are of rotation, then translation, about the sensor, along the odometry's axes
/// (1/rad^2, 1/m^2). The generalised eigenvalues of the scan's information against that of the
/// motion have no unit, and the threshold 1 has a meaning: below it every scan adds more
/// uncertainty than it takes away, and drift along that direction goes unseen. The prediction
/// itself is no measure: after a while in a tunnel it is so uncertain that any scan tells more.
/// Results are in the sensor's frame, translation first, as in Estimate. No allocation.
WeakDirections weak_directions(const Matrix6d& scan_information, const Matrix6d& motion_information,
                               const Eigen::Quaterniond& R_odom_sensor);

/// Whether it mostly moves the sensor.
bool is_translation(const WeakDirection& weak);
/// Whether it is a translation of which the scan tells next to nothing.
bool is_dead_reckoned(const WeakDirection& weak);
/// Whether any of them is.
bool is_any_dead_reckoned(const WeakDirections& weak);

/// The direction, if any, along which a scan tells far less of the translation than along either of
/// two others, if its rotation were known: the second smallest eigenvalue of the information is far
/// larger than the smallest (Zhang, Kaess and Singh, On Degeneracy of Optimization-based State
/// Estimation Problems, ICRA 2016, compare the smallest with a threshold). So a bare field, where
/// two are small, is not degenerate, and a smooth tunnel is. There what noise seems to tell of the
/// speed makes the process noise grow, until no direction is weak. The motion model does not enter
/// here. A least direction that rises by more than 45 degrees, against the odometry's axes, is left
/// out, and the other two are compared: in rooms sixteen beams may see little of the floor, but
/// nothing goes up with the sensor. A unit vector along the odometry's axes, of either sign.
std::optional<Eigen::Vector3d> degenerate_direction(const Matrix6d& scan_information);

/// The motion of a pose along its weakest dead reckoned direction, if the scan tells
/// registration::kDegenerateRatio times more of any translation across it, and it does not rise. In
/// a bend the sensor turns as it moves along.
///
/// What a scan seems to tell along it comes from the noise of the cells' normals. Such information
/// is biased: the points of a cell and its normal have their errors in common, and draw the scan
/// towards what was seen before (errors in variables; Fuller, Measurement Error Models, 1987). In a
/// tunnel this pull is some centimetres a scan: the estimated speed of a vehicle with 64 beams fell
/// from 20 to 5 m/s within 14 s, while the vehicle kept 20. So such residuals keep their
/// information, but draw the pose towards its prediction instead.
///
/// On bare ground and in dense dust the scan tells little across as well. There its residuals stay
/// as they are, because what little they tell must correct a wrong velocity: a vehicle that set off
/// on bare ground was held where it had been, and turned instead. The covariance grows all the
/// same.
class DeadReckoning {
 public:
  /// None.
  DeadReckoning() = default;
  /// As weak_directions().
  DeadReckoning(const Matrix6d& scan_information, const Matrix6d& motion_information);

  /// Of the gradient -J'Or of residuals whose information is J'OJ, replaces the part along the
  /// motion by what draws their pose back to its prediction. `deviation`: of that pose from its
  /// prediction. All are by rotation, then translation.
  void hold(const Vector6d& deviation, const Matrix6d& information, Vector6d& gradient) const;

 private:
  /// A motion with unit motion information, and that information times the motion. Zero if none.
  /// Every other generalised eigenvector of the constructor's informations has no part in the dual.
  Vector6d motion_ = Vector6d::Zero(), dual_ = Vector6d::Zero();
};

}  // namespace lilo::core
