// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/constants.hpp"
#include "core/motion/motion_state.hpp"
#include "core/registration/weak_directions.hpp"
#include "core/tracking/drift.hpp"

#include <optional>

namespace lilo::core {

/// The covariance of the pose, rotation then translation. It is the covariance of the alignment
/// with the map, in which the scan's part is scaled by how much residuals vary from azimuth to
/// azimuth, plus what predictions have added since then, plus that of the map's drift.
class PoseUncertainty {
 public:
  /// `data_weight`: of a residual (SolverConfig).
  explicit PoseUncertainty(double data_weight) : data_weight_(data_weight) {}

  /// Another map is begun where the sensor is.
  void begin_map(const MotionState& state);
  /// The same map is begun once more.
  void rewind();
  /// How uncertain the first scan of the map is, which lasted `span_s`: 8/135 q T^3, replacing the
  /// last call. `density`: q (rad^2/s^3, then m^2/s^3; ProcessNoise::density_at_start).
  void learn_start(const Vector6d& density, double span_s);
  /// A scan was aligned (Solution::design_effect, Solution::data_information). The design effect of
  /// one scan varies by chance, so that the mean of the last second counts, unless that of the scan
  /// is far larger: where a turn begins within a scan, the trajectory does not fit it, and its
  /// residuals vary more with the azimuth.
  void learn(const Vector6d& design_effect, const Matrix6d& data_information);
  /// A scan was not aligned, and the sensor is predicted from `state`. Until one is aligned the
  /// covariance grows by as much as that of the state. `over_gap`: covariance_over_gap(), which the
  /// state does not have.
  void predict(const MotionState& state, const Matrix6d& over_gap);
  /// The weak directions (sensor's axes) of a scan that lasted `span_s`; `density`: process noise.
  /// Along those of which the scan tells next to nothing the motion is dead reckoned
  /// (is_dead_reckoned()). So it is along the one direction of a degenerate scan, if a translation
  /// is weak, and, if the odometry `may_follow_traffic`, along the ground: what seems to be known
  /// there may be false.
  void learn(const WeakDirections& weak, const MotionState& state, const Vector6d& density,
             double span_s, bool may_follow_traffic = false);
  /// The sensor has moved on.
  void move(const Eigen::Vector3d& by_m) { drift_.move(by_m); }
  /// The beams' part of the covariance of the last pose (BeamCalibration::pose_covariance).
  void set_beam_covariance(const Matrix6d& covariance) { drift_.set_beam_covariance(covariance); }
  /// The last scan became a keyframe; the map has so many now.
  void add_keyframe(const MotionState& state, int keyframes);

  /// Of the pose since the first scan, in the sensor's axes.
  [[nodiscard]] Matrix6d covariance(const MotionState& state) const;
  /// Whether the pose may be off by more than 1 m or 3 degrees against the one 10 m before
  /// (RecentDrift): two of its standard errors, of the distance and of the angle. What came with
  /// a weak direction is not in it: that is reported itself, and what is seen next may know better.
  /// But what a degenerate scan may tell falsely is.
  [[nodiscard]] bool is_uncertain(const MotionState& state) const;

 private:
  /// The covariance of the last alignment and that of its state; those of all gaps since then.
  struct LastAligned {
    Matrix6d covariance, of_state, over_gaps;
  };
  [[nodiscard]] Matrix6d of_alignment(const MotionState& state) const;
  [[nodiscard]] Matrix6d without_drift(const MotionState& state) const;

  double data_weight_;
  Vector6d mean_effect_ = Vector6d::Constant(tracking::kLeastDesignEffect);  // of the last second
  double mean_weight_ = 0.0;  // of the scans in this mean
  Vector6d design_effect_ = mean_effect_;
  /// Of the last scan, as the solver weights it. Before there is one, all is taken for the scan's.
  Matrix6d data_information_ = 1e12 * Matrix6d::Identity();
  std::optional<LastAligned> last_aligned_;  // none: it is the state
  bool is_weak_ = false;  // the last scan was, along directions that are reported
  Drift drift_;
};

}  // namespace lilo::core
