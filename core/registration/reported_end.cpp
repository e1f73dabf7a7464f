// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/reported_end.hpp"

#include <Eigen/Cholesky>

#include <optional>

namespace lilo::core {

KnotInformation marginal_of_last(const NormalMatrix& H) {
  const auto n = H.rows() - kKnotSize;
  const NormalMatrix rest = H.topLeftCorner(n, n);
  const NormalMatrix cross = H.topRightCorner(n, kKnotSize);
  return H.bottomRightCorner<kKnotSize, kKnotSize>() - cross.transpose() * rest.ldlt().solve(cross);
}

// Where the trajectory departs from the prediction, by an abrupt turn or by noise, add_prior()
// inflates the process noise of the reported pose as well.
MotionState reported_end(const GaussNewtonStep& last, const Prior& prior,
                         const Trajectory& trajectory, const KnotInformation& information) {
  Prior of_reported = prior;
  of_reported.acceleration_density = prior.reported_density;
  auto [H, b] = last.data;
  add_prior(of_reported, last.from, H, b);
  const Unknowns step = H.ldlt().solve(b);
  const KnotInformation marginal = marginal_of_last(H);
  if (!step.allFinite() || !marginal.allFinite()) {
    return {trajectory.end(), trajectory.end_twist(), information, std::nullopt};
  }
  Trajectory reported = trajectory;
  reported.knots += step - last.step;  // the trajectory's step was over-relaxed
  return {reported.end(), trajectory.end_twist(), marginal, std::nullopt};
}

}  // namespace lilo::core
