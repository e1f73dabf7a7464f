// SPDX-License-Identifier: BSD-3-Clause
#include "core/motion/motion_state.hpp"

#include "core/constants.hpp"

#include <algorithm>
#include <cmath>

namespace lilo::core {

KnotInformation initial_information() {
  Knot sigma;
  sigma << Vector6d::Constant(motion::kInitialPose), motion::kInitialTilt_radps,
      motion::kInitialTilt_radps, motion::kInitialYaw_radps, motion::kInitialSpeed_mps,
      motion::kInitialSpeed_mps, motion::kClimb_mps;
  return sigma.cwiseAbs2().cwiseInverse().asDiagonal();
}

Prior predict(const MotionState& state, const ScanTiming& scan, const Vector6d& density,
              int least_segments) {
  const double duration_s = scan.span_s();
  const double since_s = state.end_ns ? seconds_between(*state.end_ns, scan.end_ns) : duration_s;
  Prior prior;
  // Returns that were compensated all belong to the end: the trajectory reaches back to the last.
  const bool reaches_back =
      scan.motion_compensated && since_s > 0.0 && since_s <= motion::kLongestGap_s;
  prior.span_s = reaches_back ? since_s : duration_s;
  const double unseen_s = since_s - prior.span_s;
  // A clock that was set counts as a gap of as much.
  if (std::abs(unseen_s) > motion::kLongestGap_s) prior.unpredicted_s = std::abs(unseen_s);
  const double gap_s = prior.unpredicted_s > 0.0 ? 0.0 : std::max(0.0, unseen_s);
  prior.T_begin = moved(state.T_odom_sensor, state.twist, gap_s);
  prior.twist = state.twist;
  prior.acceleration_density = prior.reported_density = density;
  prior.begin_information = propagated(state.information, density, gap_s);
  prior.segments = segments_for(density, prior.span_s, least_segments);
  return prior;
}

Matrix6d covariance_over_gap(const MotionState& state, const Prior& prior) {
  const Eigen::Quaterniond& R = state.T_odom_sensor.rotation;
  const double gap_s = std::min(prior.unpredicted_s, motion::kMostGap_s);
  Vector6d twist;
  twist << R * state.twist.angular_radps, R * state.twist.linear_mps;
  const Matrix6d of_twist = state.information.inverse().bottomRightCorner<6, 6>();
  Matrix6d covariance = gap_s * gap_s * (of_twist + twist * twist.transpose());
  covariance.diagonal() += gap_s * gap_s * gap_s / 3.0 * prior.acceleration_density;
  return covariance;
}

Pose predicted_end(const Prior& prior) { return moved(prior.T_begin, prior.twist, prior.span_s); }

MotionState predicted_state(const Prior& prior, std::int64_t end_ns) {
  return {predicted_end(prior), prior.twist,
          propagated(prior.begin_information, prior.acceleration_density, prior.span_s), end_ns};
}

}  // namespace lilo::core
