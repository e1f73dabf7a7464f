// SPDX-License-Identifier: BSD-3-Clause
#include "core/motion/trajectory.hpp"

#include <algorithm>

namespace lilo::core {

KnotWeights weights_at(double s, int segments, double span_s) {
  const double along = std::clamp(s, 0.0, 1.0) * segments;
  const int first = std::min(static_cast<int>(along), segments - 1);
  const double u = along - first;
  const double length_s = span_s / segments;
  const double u2 = u * u, u3 = u2 * u;
  return {
      first,
      {2 * u3 - 3 * u2 + 1, (u3 - 2 * u2 + u) * length_s, 3 * u2 - 2 * u3, (u3 - u2) * length_s}};
}

Pose Trajectory::at(double s) const {
  const KnotWeights w = weights_at(s, segments, span_s);
  Vector6d d = Vector6d::Zero();
  for (int k = 0; k < 4; ++k) {
    d += w.weight[static_cast<std::size_t>(k)] * knots.segment<6>(kKnotSize * w.first + 6 * k);
  }
  const Pose nominal = moved(T_begin, twist, s * span_s);
  return {(so3_exp(d.head<3>()) * nominal.rotation).normalized(),
          nominal.translation_m + d.tail<3>()};
}

Twist Trajectory::end_twist() const {
  const Vector6d rate = knots.segment<6>(kKnotSize * segments + 6);
  const Pose nominal = moved(T_begin, twist, span_s);
  const Eigen::Quaterniond back = end().rotation.conjugate();
  return {back * (T_begin.rotation * twist.linear_mps + rate.tail<3>()),
          back * (nominal.rotation * twist.angular_radps + rate.head<3>())};
}

Pose moved(const Pose& T, const Twist& twist, double dt_s) {
  return T * Pose{so3_exp(dt_s * twist.angular_radps), dt_s * twist.linear_mps};
}

Twist twist_between(const Pose& a, const Pose& b, double dt_s) {
  const Pose motion = a.inverse() * b;
  return {motion.translation_m / dt_s, so3_log(motion.rotation) / dt_s};
}

void sample(const Trajectory& trajectory, Sampled& sampled) {
  for (std::size_t k = 0; k <= motion::kTrajectoryInstants; ++k) {
    const Pose T = trajectory.at(static_cast<double>(k) / motion::kTrajectoryInstants);
    sampled.rotation[k] = T.rotation.toRotationMatrix().cast<float>();
    sampled.translation_m[k] = T.translation_m;
    if (k > 0) {
      sampled.velocity[k] =
          (T.translation_m - sampled.translation_m[k - 1]) * motion::kTrajectoryInstants;
    }
  }
  sampled.velocity[0] = sampled.velocity[1];
}

}  // namespace lilo::core
