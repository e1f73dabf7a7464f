// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/constants.hpp"
#include "core/registration/solver.hpp"

#include <cmath>

namespace lilo::core {

/// How much of a scan's structure fits the map, against what did of late. That an alignment
/// converged proves little: near a wrong pose something always fits. But there far less of the
/// structure does.
class StructureFit {
 public:
  /// The part that fits, over the usual part. 1 where the difference may be chance, and while the
  /// usual part is unknown. `structure`: features that are structure.
  [[nodiscard]] double relative(const Solution& solution, double structure) const {
    const double usual = usual_ * structure, found = solution.structure_inliers;
    return usual - found > registration::kPoorFitSigmas * std::sqrt(usual) ? found / usual : 1.0;
  }
  /// A scan whose alignment is believed.
  void learn(const Solution& solution, double structure) {
    if (structure < 1.0) return;
    const double fit = solution.structure_inliers / structure;
    usual_ += (usual_ > 0.0 ? registration::kFitSmoothing : 1.0) * (fit - usual_);
  }

 private:
  double usual_ = 0.0;  // 0: not known
};

/// Whether an alignment may be right: one that went astray lays hardly any structure on the map,
/// and mostly does not converge. What fits ever less, and well, is another kind of place.
inline bool is_explained(const Solution& solution, double relative_fit) {
  return relative_fit >
         (solution.converged ? registration::kChanceFit : registration::kDoubtfulFit);
}

}  // namespace lilo::core
