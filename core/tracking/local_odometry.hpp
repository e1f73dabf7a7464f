// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/motion/motion_state.hpp"
#include "core/motion/process_noise.hpp"
#include "core/motion/standing.hpp"
#include "core/odometry_config.hpp"
#include "core/registration/solver.hpp"
#include "core/registration/weak_directions.hpp"
#include "core/tracking/keyframe_map.hpp"
#include "core/tracking/observation.hpp"
#include "core/tracking/pose_uncertainty.hpp"

#include <cstddef>
#include <vector>

namespace lilo::core {

/// Odometry on one local map, scan after scan: predict, align, accept, let the map grow. It follows
/// whatever it is given; what is to be believed is decided above it, in Tracker, and Initializer
/// takes it through the first scans again where they turn out to have moved otherwise.
///
/// Poses are from where the map was begun. Not thread-safe; no allocation after construction.
class LocalOdometry {
 public:
  /// `most_features`: of one scan.
  LocalOdometry(const DefaultConfig& config, std::size_t most_features);

  [[nodiscard]] const MotionState& state() const { return state_; }
  [[nodiscard]] const KeyframeMap& map() const { return map_; }
  [[nodiscard]] Matrix6d covariance() const { return uncertainty_.covariance(state_); }

  [[nodiscard]] Prior predict(const ScanTiming& scan) const {
    return core::predict(state_, scan, process_noise_.density(), least_segments_);
  }
  /// `finest_level`: of the map, once the solution is near.
  Solution align(const std::vector<Feature>& features, const Prior& prior,
                 std::size_t finest_level = LocalMaps::kUsual) {
    return solver_.solve(features, map_.cells(), prior, finest_level);
  }
  /// The same, and where the sensor seems to stand, also from where it stood: the better one.
  Solution align_moving_or_standing(const std::vector<Feature>& features, const Prior& prior,
                                    std::size_t finest_level);
  /// The prediction as a solution of which nothing matched.
  [[nodiscard]] Solution unaligned(const Prior& prior) const { return solver_.unaligned(prior); }

  /// The sensor moved as a scan's solution says.
  void accept(const ScanTiming& scan, const Solution& solution);
  /// Of a scan that could not be aligned the prediction is all that is known.
  void accept_prediction(const ScanTiming& scan, const Prior& prior);
  /// The first scan of a map: its last firing is the origin.
  void accept_first(const ScanTiming& scan) { state_.end_ns = scan.end_ns; }

  /// Learns from the motion just accepted whether the sensor stands.
  void observe_standing() { standing_.observe(state_.T_odom_sensor, state_.twist); }
  [[nodiscard]] bool is_standing() const { return standing_.is_likely(); }
  /// It is taken to stand where it is.
  void assume_standing() { standing_.begin(state_.T_odom_sensor); }
  /// Finds what a scan that was accepted told too little of: there the motion is dead reckoned, and
  /// the pose the less certain.
  WeakDirections find_weak_directions(const ScanTiming& scan, const Solution& solution);
  /// Learns how fast the motion changes, from a scan that was aligned (ProcessNoise).
  void observe_noise(const ScanTiming& scan, const Solution& solution);
  /// What comes next does not continue the motion observed so far.
  void interrupt_noise() { process_noise_.interrupt(); }

  /// What the scan accepted last adds to the map, of all of its features.
  void grow_map(const Observation& scan, const std::vector<Feature>& features,
                const Solution& solution, MapUse use,
                const PoseSensitivity& sensitivity = PoseSensitivity::Zero());
  /// Of the scan just aligned, before it enters the map.
  BeamEquations beam_equations(const std::vector<Feature>& features, const Trajectory& trajectory) {
    return solver_.beam_equations(features, map_.cells(), trajectory);
  }

  /// Gives the map up and begins another, at the end of its first scan. Returns where that is
  /// predicted to be.
  Pose begin_map(const ScanTiming& first);
  /// Back to the end of the first scan.
  void rewind(const ScanTiming& first);
  /// Builds the map of one scan alone, deskewed by `trajectory`.
  void begin_map_of(const std::vector<Feature>& features, const Trajectory& trajectory,
                    std::size_t finest_level) {
    map_.begin(features, trajectory, finest_level);
  }

 private:
  /// An exceptional motion is taken only where it fits significantly better than a usual one: where
  /// little of a scan matches, the heavy tails of the prior let it jump to a place like its own.
  Solution align_moving(const std::vector<Feature>& features, const Prior& prior,
                        std::size_t finest_level);
  void move_to(const MotionState& state);

  Solver solver_;
  KeyframeMap map_;
  ProcessNoise process_noise_;
  PoseUncertainty uncertainty_;
  Standing standing_;
  MotionState state_;
  int least_segments_;
};

}  // namespace lilo::core
