// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/calibration/beam_correction.hpp"
#include "core/calibration/beam_estimate.hpp"
#include "core/pose.hpp"

#include <Eigen/Core>

#include <array>
#include <optional>

/// Estimation of beam errors from the residuals of the map, while driving.
namespace lilo::core {

/// How a pose depends on the eccentricity: rotation and translation (rows, odometry axes) per
/// radian of its cosine and sine.
using PoseSensitivity = Eigen::Matrix<double, 6, 2>;

/// Normal equations of the beams' errors, from one scan that was aligned with the map. Residuals
/// are weighted as in the alignment.
struct BeamEquations {
  /// Of the elevation of each ring, from ground alone, at the pose of the alignment.
  std::array<double, kMaxRings> elevation_gradient{}, elevation_information{};
  /// Of pose and eccentricity together: the blocks of H and b of H x = b.
  Matrix6d pose_information = Matrix6d::Zero();
  PoseSensitivity cross_information = PoseSensitivity::Zero();
  Eigen::Matrix2d eccentricity_information = Eigen::Matrix2d::Zero();
  Vector6d pose_gradient = Vector6d::Zero();
  Eigen::Vector2d eccentricity_gradient = Eigen::Vector2d::Zero();
};

/// Estimates the differences between the elevations of the rings, and the eccentricity of the
/// encoder.
///
/// Rings: the elevation of a ring follows the mean residual of its ground returns against the map,
/// which holds the returns of all rings. These residuals do not show an error that all rings share:
/// the same error of all elevations turns level ground into a cone, and an error that grows with
/// the elevation lowers the ground. So a line fitted over the elevations is subtracted.
///
/// Eccentricity: the points of the map were measured with the same encoder, and its error bends the
/// path. So every point that enters the map brings its derivative by the eccentricity, with that of
/// its pose. The derivative of a residual is that of its point minus that of its cell. This is
/// Gauss-Newton over all scans, in which each pose is a function of the eccentricity.
///
/// Not thread-safe; no allocation.
class BeamCalibration {
 public:
  [[nodiscard]] const BeamCorrection& correction() const { return correction_; }
  /// Begins with what an earlier run found. It is believed less than it says (kKeptSigma_rad), so
  /// that another sensor of the same kind is learnt soon.
  void resume(const BeamEstimate& kept);
  /// Before each scan. At the first one after resume() what was kept is dropped if it is of a
  /// sensor with another number of rings. Of some recordings every scan has its own number.
  void begin_scan(const BeamTable& beams);
  [[nodiscard]] BeamEstimate estimate() const;
  /// Of the last scan that was observed.
  [[nodiscard]] const PoseSensitivity& sensitivity() const { return sensitivity_; }
  /// Whether the sensor has moved far enough since the last observation. At the same place the
  /// residuals are the same, and would count again.
  [[nodiscard]] bool is_due(const Eigen::Vector3d& place_m) const;
  /// The scan ended at `place_m` (odometry frame).
  void observe(const BeamEquations& scan, const BeamTable& beams, const Eigen::Vector3d& place_m);
  /// Poses on a new map do not depend on the eccentricity yet. The correction stays.
  void begin_map();

 private:
  void observe_elevations(const BeamEquations& scan, const BeamTable& beams);
  void subtract_common_line(const BeamTable& beams);
  void observe_eccentricity(const BeamEquations& scan);

  int ring_count_ = 0;       // of the last scan; 0: none yet
  int kept_ring_count_ = 0;  // of what is resumed; 0: nothing, or it was looked at
  BeamCorrection correction_;
  std::array<double, kMaxRings> elevation_information_{};
  /// H and b of H x = b over all observations, x the whole eccentricity.
  Eigen::Matrix2d eccentricity_information_ = Eigen::Matrix2d::Zero();
  Eigen::Vector2d eccentricity_sum_ = Eigen::Vector2d::Zero();
  PoseSensitivity sensitivity_ = PoseSensitivity::Zero();
  std::optional<Eigen::Vector3d> last_place_m_;
};

}  // namespace lilo::core
