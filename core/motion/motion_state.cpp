// SPDX-License-Identifier: BSD-3-Clause
#include "core/motion/motion_state.hpp"

#include "core/constants.hpp"

#include <algorithm>

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
  const double gap_s = unseen_s > motion::kLongestGap_s ? 0.0 : std::max(0.0, unseen_s);
  prior.T_begin = moved(state.T_odom_sensor, state.twist, gap_s);
  prior.twist = state.twist;
  prior.acceleration_density = density;
  prior.begin_information = propagated(state.information, density, gap_s);
  prior.segments = segments_for(density, prior.span_s, least_segments);
  return prior;
}

Pose predicted_end(const Prior& prior) { return moved(prior.T_begin, prior.twist, prior.span_s); }

MotionState predicted_state(const Prior& prior, std::int64_t end_ns) {
  return {predicted_end(prior), prior.twist,
          propagated(prior.begin_information, prior.acceleration_density, prior.span_s), end_ns};
}

}  // namespace lilo::core
