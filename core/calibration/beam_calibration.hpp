// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/calibration/beam_correction.hpp"
#include "core/pose.hpp"

#include <Eigen/Core>

#include <array>
#include <optional>

/// Estimation of beam errors from the residuals of the map, while driving.
namespace lilo::core {

/// How a pose depends on the eccentricity: rotation and translation (rows, odometry axes) per
/// radian of its cosine and sine.
using PoseSensitivity = Eigen::Matrix<double, 6, 2>;

/// What one scan, aligned with the map, says of its beams. Residuals are weighted as in the
/// alignment.
struct BeamEquations {
  /// Of each ring's elevation, from ground alone, with the pose as it was found.
  std::array<double, kMaxRings> elevation_gradient{}, elevation_information{};
  /// Of pose and eccentricity together: H and b of H x = b, of the pose, of both, and of the
  /// eccentricity.
  Matrix6d pose_information = Matrix6d::Zero();
  PoseSensitivity cross_information = PoseSensitivity::Zero();
  Eigen::Matrix2d eccentricity_information = Eigen::Matrix2d::Zero();
  Vector6d pose_gradient = Vector6d::Zero();
  Eigen::Vector2d eccentricity_gradient = Eigen::Vector2d::Zero();
};

/// Estimates the differences between the elevations of the rings, and the eccentricity of the
/// encoder.
///
/// Rings: the elevation of each follows the mean residual of its ground returns, to which the other
/// rings gave the map. What all rings have in common is not seen in this way: an error of all
/// elevations makes a cone of level ground, and one that grows with the elevation lowers the
/// ground. So the fit of both is taken out, and the sensor keeps its nominal mean.
///
/// Eccentricity: the map was laid by the same encoder, and its error bends the path. So the
/// derivative by the eccentricity is carried along: each point that enters the map brings its own,
/// with that of its pose, and a residual's derivative is its point's less its cell's. (This is
/// Gauss-Newton over all scans, in which each pose is a function of the eccentricity.)
///
/// Not thread-safe; no allocation.
class BeamCalibration {
 public:
  [[nodiscard]] const BeamCorrection& correction() const { return correction_; }
  /// Of the last scan that was observed.
  [[nodiscard]] const PoseSensitivity& sensitivity() const { return sensitivity_; }
  /// Whether the sensor has moved enough since the last observation: from the same place the same
  /// residuals come again.
  [[nodiscard]] bool is_due(const Eigen::Vector3d& place_m) const;
  /// The scan ended at `place_m` (odometry frame).
  void observe(const BeamEquations& scan, const BeamTable& beams, const Eigen::Vector3d& place_m);
  /// A new map knows nothing of the eccentricity; the correction stays.
  void begin_map();

 private:
  void observe_elevations(const BeamEquations& scan, const BeamTable& beams);
  void keep_nominal_mean(const BeamTable& beams);
  void observe_eccentricity(const BeamEquations& scan);

  BeamCorrection correction_;
  std::array<double, kMaxRings> elevation_rad_{}, information_{};
  Eigen::Matrix2d eccentricity_information_ = Eigen::Matrix2d::Zero();
  Eigen::Vector2d eccentricity_rad_ = Eigen::Vector2d::Zero(),
                  eccentricity_sum_ = eccentricity_rad_;
  PoseSensitivity sensitivity_ = PoseSensitivity::Zero();
  std::optional<Eigen::Vector3d> last_place_m_;
};

}  // namespace lilo::core
