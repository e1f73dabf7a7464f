// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/motion/motion_prior.hpp"
#include "core/motion/motion_state.hpp"
#include "core/motion/trajectory.hpp"

/// The pose at the end of a scan, as it is reported.
///
/// The trajectory of a scan begins the next one and places points in the map. It needs room for a
/// motion that nobody expects, so that its process noise has a least value, and noise moves its end
/// by more than a smooth vehicle moves. Nothing goes on from the reported pose. It is found under
/// a process noise of its own (Prior::reported_density), by the last step of Gauss-Newton, taken
/// once more. Its covariance comes from the same step. The twist stays that of the trajectory: the
/// twist of that step was as far from the truth.
namespace lilo::core {

/// H step = b of the deviation from the predicted motion, over all knots.
struct KnotEquations {
  NormalMatrix H;
  Unknowns b;
};

/// Marginal information of the last knot: the Schur complement.
KnotInformation marginal_of_last(const NormalMatrix& H);

struct GaussNewtonStep {
  KnotEquations data;  ///< of the residuals alone
  NormalMatrix H;      ///< with the prior
  Unknowns from, step;
};

/// `last`: the step that led to `trajectory`; `information`: of its last knot, which is reported
/// with its end where no other step is found. No stamp is set; no allocation.
MotionState reported_end(const GaussNewtonStep& last, const Prior& prior,
                         const Trajectory& trajectory, const KnotInformation& information);

}  // namespace lilo::core
