// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/motion/motion_state.hpp"
#include "core/motion/process_noise.hpp"
#include "core/motion/stationary_detector.hpp"
#include "core/odometry_config.hpp"
#include "core/registration/solver.hpp"
#include "core/registration/weak_directions.hpp"
#include "core/tracking/keyframe_map.hpp"
#include "core/tracking/observation.hpp"
#include "core/tracking/pose_uncertainty.hpp"

#include <cstddef>
#include <vector>

namespace lilo::core {

/// Odometry on one local map: predict, align, accept and grow the map, scan after scan. It decides
/// nothing: Tracker decides which alignment is accepted, and Initializer repeats the first scans
/// when their motion turns out to be another one.
///
/// Poses count from where the map was begun. Not thread-safe; no allocation after construction.
class LocalOdometry {
 public:
  /// `most_features`: of one scan.
  LocalOdometry(const DefaultConfig& config, std::size_t most_features);

  /// From where the next scan is predicted.
  [[nodiscard]] const MotionState& state() const { return state_; }
  /// For whoever asks where the sensor is (reported_end()). Its stamp is that of the state.
  [[nodiscard]] const MotionState& reported() const { return reported_; }
  /// Of the reported pose.
  [[nodiscard]] Matrix6d covariance() const { return uncertainty_.covariance(reported_); }
  /// Of the reported pose, as in PoseUncertainty.
  [[nodiscard]] bool is_uncertain() const { return uncertainty_.is_uncertain(reported_); }
  [[nodiscard]] const KeyframeMap& map() const { return map_; }

  [[nodiscard]] Prior predict(const ScanTiming& scan) const {
    Prior prior = core::predict(state_, scan, process_noise_.density(), least_segments_);
    prior.reported_density = process_noise_.reported_density();
    return prior;
  }
  /// `levels`, `sides`: as in Solver::solve().
  Solution align(const std::vector<Feature>& features, const Prior& prior,
                 Levels levels = Levels::from_whole, Sides sides = Sides::seen) {
    return solver_.solve(features, map_.cells(), prior, levels, sides);
  }
  /// The prediction as a solution in which nothing matched.
  [[nodiscard]] Solution unaligned(const Prior& prior) const { return solver_.unaligned(prior); }

  /// Moves the state to the end of a scan by its solution.
  void accept(const ScanTiming& scan, const Solution& solution);
  /// The same by the prediction, for a scan that could not be aligned.
  void accept_prediction(const ScanTiming& scan, const Prior& prior);
  /// The first scan of a map: its last firing is the origin.
  void accept_first(const ScanTiming& scan) { state_.end_ns = scan.end_ns; }

  /// Learns from the motion just accepted whether the sensor is stationary.
  void observe_stationary() {
    stationary_.observe(state_.T_odom_sensor.translation_m, state_.twist);
  }
  [[nodiscard]] bool is_stationary() const { return stationary_.is_stationary(); }
  /// The sensor is assumed to be stationary where it is.
  void assume_stationary() { stationary_.assume(state_.T_odom_sensor.translation_m); }
  /// Finds the weak directions of a scan that was accepted. Along those of which it tells next to
  /// nothing the motion is dead reckoned (is_dead_reckoned()), and the covariance of the pose
  /// grows. `may_follow_traffic`: as in PoseUncertainty.
  WeakDirections find_weak_directions(const ScanTiming& scan, const Solution& solution,
                                      bool may_follow_traffic = false);
  /// Learns how fast the motion changes, from a scan that was aligned (ProcessNoise), and so how
  /// uncertain the first scan of the map is.
  void observe_noise(const ScanTiming& scan, const Solution& solution);
  /// The next scan does not continue the motion observed so far.
  void interrupt_noise() { process_noise_.interrupt(); }

  /// Adds the scan accepted last to the map, with all of its features.
  void grow_map(const Observation& scan, const std::vector<Feature>& features,
                const Solution& solution, MapUse use);
  /// How scans depend on the errors of the beams, from now on.
  void set_sensitivity(const ScanSensitivity& sensitivity) { map_.set_sensitivity(sensitivity); }
  /// The beams' part of the covariance of the last pose (BeamCalibration::pose_covariance).
  void set_beam_covariance(const Matrix6d& covariance) {
    uncertainty_.set_beam_covariance(covariance);
  }
  /// Of the scan just aligned, before it enters the map.
  BeamEquations beam_equations(const std::vector<Feature>& features, const Trajectory& trajectory,
                               const ScanSensitivity& sensitivity) {
    return solver_.beam_equations(features, map_.cells(), trajectory, sensitivity);
  }
  /// Subtracts a rigid motion from the sensitivities of the map.
  void subtract_sensitivity(const PoseSensitivity& rigid) { map_.subtract_sensitivity(rigid); }

  /// Gives the map up and begins another one, whose origin is the end of the scan `first`. Returns
  /// the predicted pose of that end in the old map.
  Pose begin_map(const ScanTiming& first);
  /// Goes back to the end of the first scan.
  void rewind(const ScanTiming& first);
  /// Makes the map of one scan alone, deskewed by `trajectory`.
  void begin_map_of(const std::vector<Feature>& features, const Trajectory& trajectory,
                    std::size_t finest_level) {
    map_.begin(features, trajectory, finest_level);
  }

 private:
  void move_to(const MotionState& state);

  Solver solver_;
  KeyframeMap map_;
  ProcessNoise process_noise_;
  PoseUncertainty uncertainty_;
  StationaryDetector stationary_;
  MotionState state_, reported_;
  double first_span_s_ = 0.0;  // of the map's first scan
  int least_segments_;
};

}  // namespace lilo::core
