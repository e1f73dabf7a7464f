// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/constants.hpp"
#include "core/registration/structure_fit.hpp"
#include "core/search/displacement_search.hpp"
#include "core/tracking/local_odometry.hpp"
#include "core/tracking/observation.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace lilo::core {

/// What the alignments up to now tell of the next one.
struct AlignmentHistory {
  std::int64_t end_ns = 0;   ///< last firing of the last scan that was aligned
  bool is_doubtful = false;  ///< the last scan, aligned or not, fitted much less than usual
  bool was_covered = false;  ///< the last scan said too little: this one may be a fragment
  StructureFit fit;          ///< the usual fit

  /// Time from the last aligned scan to the beginning of this one. A clock that was set back counts
  /// like one that was set forward.
  [[nodiscard]] double unseen_s(const ScanTiming& scan) const {
    return std::abs(seconds_between(end_ns, scan.start_ns));
  }
};

/// Finds the sensor in the map where an alignment from the prediction does not reach.
///
/// After a second without the sensor the prediction may be off by metres and tens of degrees. That
/// is too far for an alignment, and yet some of the scan always matches. So DisplacementSearch
/// tries all places that a vehicle can have reached, and the scan is aligned from the best of them.
/// One alignment is taken, if significantly more of the structure fits than in any other.
///
/// Not thread-safe; no allocation after construction.
class Relocalizer {
 public:
  /// `most_features`: of one scan.
  explicit Relocalizer(std::size_t most_features) : search_(most_features) {}

  /// The best alignment around the prediction; none if no place is significantly the best.
  /// `at_prediction`: the alignment from the prediction itself.
  std::optional<Solution> find(const Observation& scan, const Prior& prior,
                               const Solution& at_prediction, const AlignmentHistory& history,
                               LocalOdometry& local);

  /// Follows an abrupt turn. If `found`, the alignment from the prediction, fits far worse than
  /// usual, turns within the scan are searched, then turns that began within the last one. One is
  /// taken if significantly more of the structure fits, and not less of the ground; else `found`.
  Solution follow_turn(const Solution& found, const Observation& scan, const Prior& prior,
                       const AlignmentHistory& history, LocalOdometry& local);

 private:
  void draw_map(const Eigen::Vector3d& center_m, const LocalOdometry& local);
  void attempt_all(const Observation& scan, const Prior& prior, const Solution& at_prediction,
                   const AlignmentHistory& history, LocalOdometry& local);
  std::optional<Solution> better_turned(const Solution& found, const Observation& scan,
                                        const Prior& prior, const AlignmentHistory& history,
                                        const SearchRadius& radius, LocalOdometry& local);
  [[nodiscard]] bool is_unambiguous(const Solution& best) const;
  [[nodiscard]] std::span<Solution> attempts() {
    return std::span(attempts_).first(attempt_count_);
  }

  DisplacementSearch search_;
  std::optional<std::uint64_t> drawn_revision_;  // of the map that the search was given
  std::array<Solution, search::kMostPlaces + 1> attempts_;
  std::size_t attempt_count_ = 0;
};

/// Whether an alignment is exactly where it was predicted, fits as usual and has no weak direction.
bool is_in_place(const Solution& found, const Prior& prior, double relative_fit);

}  // namespace lilo::core
