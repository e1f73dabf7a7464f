// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/constants.hpp"
#include "core/registration/solver.hpp"

#include <algorithm>
#include <cmath>

namespace lilo::core {

/// How much of a scan's structure fits the map, compared with the last scans. That an alignment
/// converged proves little, since something fits at a wrong pose too; but far less structure does.
///
/// How much fits varies by chance (Poisson), and with the scene. On bare hills it varies far more
/// than by chance: the structure is boulders and steep ground, of which each crest shows others.
class StructureFit {
 public:
  /// The part of the structure that fits, over the usual part. 1 where the difference may be
  /// chance or is usual here, and while the usual part is unknown. `structure`: number of features.
  [[nodiscard]] double relative(const Solution& solution, double structure) const {
    const double usual = usual_ * structure, found = solution.structure_inliers;
    const double variance = usual + variance_ * structure * structure;
    return usual - found > registration::kPoorFitSigmas * std::sqrt(variance) ? found / usual : 1.0;
  }
  /// Learns the usual part, and how it varies, from a scan whose alignment is believed.
  void learn(const Solution& solution, double structure) {
    if (structure < 1.0) return;
    const double fit = solution.structure_inliers / structure;
    if (usual_ > 0.0) {
      const double change = fit - usual_;
      const double beyond_chance = std::max(0.0, change * change - usual_ / structure);
      variance_ += registration::kFitVarianceSmoothing * (beyond_chance - variance_);
      usual_ += registration::kFitSmoothing * change;
    } else {
      usual_ = fit;
    }
  }

 private:
  double usual_ = 0.0;     // 0: not known
  double variance_ = 0.0;  // of the part that fits, beyond chance
};

/// Whether an alignment may be right. A wrong one lays hardly any structure on the map and mostly
/// does not converge. One that converged may fit less than usual: the sensor comes to another kind
/// of place.
inline bool is_explained(const Solution& solution, double relative_fit) {
  return relative_fit >
         (solution.converged ? registration::kChanceFit : registration::kDoubtfulFit);
}

}  // namespace lilo::core
