// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/constants.hpp"
#include "core/registration/solver.hpp"

#include <cmath>

namespace lilo::core {

/// How much of a scan's structure fits the map, compared with the last scans. That an alignment
/// converged proves little, since something fits at a wrong pose too; but far less structure does.
class StructureFit {
 public:
  /// The part of the structure that fits, over the usual part. 1 where the difference may be
  /// chance, and while the usual part is unknown. `structure`: number of structure features.
  [[nodiscard]] double relative(const Solution& solution, double structure) const {
    const double usual = usual_ * structure, found = solution.structure_inliers;
    return usual - found > registration::kPoorFitSigmas * std::sqrt(usual) ? found / usual : 1.0;
  }
  /// Learns the usual part from a scan whose alignment is believed.
  void learn(const Solution& solution, double structure) {
    if (structure < 1.0) return;
    const double fit = solution.structure_inliers / structure;
    usual_ += (usual_ > 0.0 ? registration::kFitSmoothing : 1.0) * (fit - usual_);
  }

 private:
  double usual_ = 0.0;  // 0: not known
};

/// Whether an alignment may be right. A wrong one lays hardly any structure on the map and mostly
/// does not converge. One that converged may fit less than usual: the sensor comes to another kind
/// of place.
inline bool is_explained(const Solution& solution, double relative_fit) {
  return relative_fit >
         (solution.converged ? registration::kChanceFit : registration::kDoubtfulFit);
}

}  // namespace lilo::core
