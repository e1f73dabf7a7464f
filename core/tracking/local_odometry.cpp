// SPDX-License-Identifier: BSD-3-Clause
#include "core/tracking/local_odometry.hpp"

#include "core/constants.hpp"

#include <Eigen/LU>

namespace lilo::core {
namespace {

SolverConfig solver_config(const DefaultConfig& c) {
  return {.max_iterations = c.max_iterations,
          .ground_kernel = static_cast<float>(c.ground_kernel),
          .structure_kernel = static_cast<float>(c.structure_kernel),
          .data_weight = static_cast<float>(c.data_weight)};
}

Vector6d nominal_density(const DefaultConfig& c) {
  Vector6d density;
  density << c.roll_pitch_density, c.roll_pitch_density, c.yaw_density,
      Eigen::Vector3d::Constant(c.translation_density);
  return density;
}

}  // namespace

LocalOdometry::LocalOdometry(const DefaultConfig& config, std::size_t most_features)
    : solver_(solver_config(config), most_features),
      map_(config),
      process_noise_(nominal_density(config)),
      uncertainty_(config.data_weight),
      least_segments_(config.segments) {}

void LocalOdometry::accept(const ScanTiming& scan, const Solution& solution) {
  const Trajectory& trajectory = solution.trajectory;
  move_to({trajectory.end(), trajectory.end_twist(), solution.end_information, scan.end_ns});
  reported_ = solution.reported;
  uncertainty_.learn(solution.design_effect, solution.data_information);
}

void LocalOdometry::accept_prediction(const ScanTiming& scan, const Prior& prior) {
  uncertainty_.predict(state_, covariance_over_gap(state_, prior));
  move_to(predicted_state(prior, scan.end_ns));
}

void LocalOdometry::move_to(const MotionState& state) {
  uncertainty_.move(state.T_odom_sensor.translation_m - state_.T_odom_sensor.translation_m);
  state_ = reported_ = state;
}

WeakDirections LocalOdometry::find_weak_directions(const ScanTiming& scan, const Solution& solution,
                                                   bool may_follow_traffic) {
  WeakDirections weak = weak_directions(solution.data_information, solution.motion_information,
                                        state_.T_odom_sensor.rotation);
  uncertainty_.learn(weak, state_, process_noise_.density(), scan.span_s(), may_follow_traffic);
  return weak;
}

void LocalOdometry::observe_noise(const ScanTiming& scan, const Solution& solution) {
  process_noise_.observe(solution.trajectory.at(0.5),
                         scan.start_ns + (scan.end_ns - scan.start_ns) / 2,
                         solution.data_information.inverse().diagonal());
  uncertainty_.learn_start(process_noise_.density_at_start(), first_span_s_);
}

void LocalOdometry::grow_map(const Observation& scan, const std::vector<Feature>& features,
                             const Solution& solution, MapUse use) {
  if (map_.grow({scan.timing, features, solution, state_.T_odom_sensor, use,
                 LocalMaps::finest_of(scan.levels), scan.is_room})) {
    uncertainty_.add_keyframe(state_, map_.keyframes());
  }
}

Pose LocalOdometry::begin_map(const ScanTiming& first) {
  accept_prediction(first, predict(first));
  Pose at = state_.T_odom_sensor;
  first_span_s_ = first.span_s();
  uncertainty_.begin_map(state_);
  process_noise_.begin_map();
  stationary_.reset();
  state_ = reported_ = {};
  map_.clear();
  return at;
}

void LocalOdometry::rewind(const ScanTiming& first) {
  first_span_s_ = first.span_s();
  uncertainty_.rewind();
  process_noise_.begin_map();
  stationary_.reset();
  state_ = reported_ = {};
  state_.end_ns = first.end_ns;
}

}  // namespace lilo::core
