// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/calibration/beam_correction.hpp"
#include "core/calibration/beam_equations.hpp"
#include "core/calibration/beam_estimate.hpp"
#include "core/calibration/common_prior.hpp"
#include "core/pose.hpp"

#include <Eigen/Core>

#include <array>
#include <optional>

/// Estimation of beam errors from the residuals of the map, while driving.
namespace lilo::core {

/// Estimates the errors of the elevations and the eccentricity of the encoder.
///
/// Rings: the elevation of a ring follows the mean residual of its ground returns against the map,
/// which holds the returns of all rings. Two errors that all rings share are not in these
/// residuals: one that grows with the elevation lowers the ground, and one in inverse proportion
/// to it bends the path (common_part_of). So a fit of both over the elevations is subtracted. The
/// first does no harm.
///
/// The errors that bend the path, the eccentricity and the common error of the elevations: the
/// points of the map were measured with the same beams. So every point that enters the map brings
/// its derivative by these errors, with that of its pose. The derivative of a residual is that of
/// its point minus that of its cell. This is Gauss-Newton over all scans, in which each pose is a
/// function of the errors. What a ring's residuals have in common is left out, as errors of single
/// rings would be taken for these. How large the errors of single rings are tells how large the
/// common error may be (common_prior()).
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
  /// Of the scan begun last. Its pose is that of the last scan that was observed.
  [[nodiscard]] const ScanSensitivity& sensitivity() const { return sensitivity_; }
  /// Whether the sensor has moved far enough since the last observation, or from the origin of the
  /// map. At the same place the residuals are the same, and would count again.
  [[nodiscard]] bool is_due(const Eigen::Vector3d& place_m) const;
  /// The scan ended at `place_m` (odometry frame).
  void observe(const BeamEquations& scan, const BeamTable& beams, const Eigen::Vector3d& place_m);
  /// On a long way sensitivities grow until floats do not hold their differences (kRebase_m). Then
  /// gives the rigid motion that the caller is to subtract from the map. It changes no difference.
  [[nodiscard]] std::optional<PoseSensitivity> rebase();
  /// The beams' part of the covariance of the pose of the last observed scan: rotation then
  /// translation, odometry axes (rad, m). J C J' + e e': J is how the pose moves with the errors
  /// that bend the path, C the covariance of their estimate, and e what corrections that came late
  /// have left in the pose. Zero where the information is not positive.
  [[nodiscard]] Matrix6d pose_covariance() const;
  /// Poses on a new map do not depend on the errors yet. The correction stays.
  void begin_map();

 private:
  /// The derivative of a ring's mean residual by the errors, times the information of the mean.
  struct RingMean {
    Eigen::Matrix<double, 1, kBeamErrors> by_errors = Eigen::Matrix<double, 1, kBeamErrors>::Zero();
    double information = 0.0;
  };
  using Information = Eigen::Matrix<double, kBeamErrors, kBeamErrors>;
  using Errors = Eigen::Matrix<double, kBeamErrors, 1>;

  struct FoundErrors {
    Errors mean_rad;
    Information covariance_rad2;
  };

  void observe_elevations(const BeamEquations& scan, const BeamTable& beams);
  void subtract_unseen(const BeamTable& beams);
  void observe_path(const BeamEquations& scan, const Eigen::Vector3d& place_m);
  void leave_out_rings(const std::array<RingEquations, kMaxRings>& rings,
                       const PathEquations::Cross& followed, const Vector6d& moved,
                       ErrorEquations& of_errors);
  void add_path(const ErrorEquations& errors);
  void expect_common(const BeamTable& beams);
  [[nodiscard]] std::optional<FoundErrors> found_with(const CommonPrior& common) const;
  void correct_path();

  int ring_count_ = 0;       // of the last scan; 0: none yet
  int kept_ring_count_ = 0;  // of what is resumed; 0: nothing, or it was looked at
  BeamCorrection correction_;
  std::array<double, kMaxRings> elevation_information_{};
  /// H and b of H x = b over all observations, x the errors without any correction.
  Information information_ = Information::Zero();
  Errors sum_ = Errors::Zero();
  CommonPrior common_prior_;
  std::array<RingMean, kMaxRings> ring_means_{};
  ScanSensitivity sensitivity_;
  PoseSensitivity rebased_;  // what was subtracted from the pose's since the map was begun
  std::optional<Eigen::Vector3d> last_place_m_;
};

}  // namespace lilo::core
