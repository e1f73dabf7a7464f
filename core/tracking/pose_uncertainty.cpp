// SPDX-License-Identifier: BSD-3-Clause
#include "core/tracking/pose_uncertainty.hpp"

#include "core/constants.hpp"

#include <Eigen/LU>

namespace lilo::core {

void PoseUncertainty::begin_map(const MotionState& state) {
  drift_.begin(covariance(state));  // the sensor's axes are the new map's
}

void PoseUncertainty::learn(const Vector6d& design_effect) {
  design_effect_ += tracking::kDesignEffectSmoothing *
                    (design_effect.cwiseMax(tracking::kLeastDesignEffect) - design_effect_);
}

void PoseUncertainty::add_keyframe(const MotionState& state, int keyframes) {
  drift_.inherit(of_alignment(state), state.T_odom_sensor.rotation, keyframes);
}

void PoseUncertainty::learn(const WeakDirections& weak, const MotionState& state,
                            const Vector6d& density, double span_s) {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
  int count = 0;
  for (int k = 0; k < weak.count && count < 3; ++k) {
    const WeakDirection& one = weak.all[static_cast<std::size_t>(k)];
    const Eigen::Vector3d along = one.direction.head<3>();  // m
    if (one.from_scan > tracking::kDeadReckonedShare || along.norm() < tracking::kMostlyTurns_m) {
      continue;
    }
    axes.col(count++) = state.T_odom_sensor.rotation * along.normalized();
  }
  if (count == 0) {
    drift_.see(span_s);
  } else {
    drift_.coast(axes, density.segment<2>(3).mean(), span_s);
  }
}

/// Against the map, in the odometry's axes.
Matrix6d PoseUncertainty::of_alignment(const MotionState& state) const {
  // The error of a cell is the same for all scans that are matched with it: so many of them count
  // as one. What is the same for longer is for Drift.
  const double unit = tracking::kScansSharingErrors * data_weight_;
  const Vector6d scale = (unit * design_effect_).cwiseSqrt();
  return scale.asDiagonal() * state.information.inverse().topLeftCorner<6, 6>() *
         scale.asDiagonal();
}

Matrix6d PoseUncertainty::covariance(const MotionState& state) const {
  return in_sensor_axes(drift_.covariance() + of_alignment(state), state.T_odom_sensor.rotation);
}

}  // namespace lilo::core
