// SPDX-License-Identifier: BSD-3-Clause
#include "core/search/motion_check.hpp"

#include "core/constants.hpp"
#include "core/search/hypothesis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lilo::core {

MotionCheck::MotionCheck(std::size_t most_features)
    : scans_(most_features), spaced_scans_(most_features), grid_(most_features) {
  structure_.reserve(most_features);
}

void MotionCheck::clear() {
  scans_.clear();
  spaced_scans_.clear();
  scan_count_ = 0;
  times_refuted_ = 0;
  suspected_mps_.reset();
  ambiguity_ = 0.0;
  count_ambiguous_scans();
}

void MotionCheck::add(const std::vector<Feature>& features, const Pose& T_begin, const Pose& T_end,
                      const ScanTiming& timing) {
  structure_.assign(features);
  ++scan_count_;
  if (newest_has_structure()) {
    scans_.add(structure_, T_begin, T_end, timing);
    if (newest_is_spaced()) spaced_scans_.add(structure_, T_begin, T_end, timing);
  } else {
    scans_.clear();
    spaced_scans_.clear();
    times_refuted_ = 0;
  }
  count_ambiguous_scans();
}

void MotionCheck::count_ambiguous_scans() {
  ambiguity_ended_ = !is_ambiguous() && ambiguous_scans_ >= search::kAmbiguousScans &&
                     2 * dead_reckoned_scans_ < ambiguous_scans_;
  if (is_ambiguous()) {
    ++ambiguous_scans_;
  } else {
    ambiguous_scans_ = dead_reckoned_scans_ = 0;
  }
}

/// The fewest cells occupied under motions that are faster or slower along the axis, or across it;
/// `limit` if none has fewer.
int MotionCheck::least_occupied(const Eigen::Vector2d& axis, Subsample subsample, int limit) {
  int least = limit;
  for (const double speed_mps : search::kFalseMotions_mps) {
    const Eigen::Vector2d along_mps = speed_mps * axis;
    const Eigen::Vector2d across_mps(-along_mps.y(), along_mps.x());
    for (const Eigen::Vector2d& faster_mps :
         {along_mps, Eigen::Vector2d(-along_mps), across_mps, Eigen::Vector2d(-across_mps)}) {
      least = scans_.occupied_under(faster_mps, subsample, grid_, least);
    }
  }
  return least;
}

/// Looks for a speed along the axis under which fewer cells are occupied than `of_quarter`, among
/// an eighth of all speeds (kSpeedParts) and the one found last.
void MotionCheck::suspect_speed(const Eigen::Vector2d& axis, int of_quarter) {
  const std::optional<Eigen::Vector2d> last_mps = std::exchange(suspected_mps_, std::nullopt);
  int least = of_quarter;
  const auto try_speed = [&](double speed_mps) {
    const int cells = scans_.occupied_at(speed_mps, axis, Subsample::quarter, grid_, least);
    if (cells == least) return;
    least = cells;
    suspected_mps_ = speed_mps * axis;
  };
  if (last_mps) try_speed(last_mps->dot(axis));
  const int first = scan_count_ % search::kSpeedParts - search::kSpeeds;
  for (int step = first; step <= search::kSpeeds; step += search::kSpeedParts) {
    try_speed(step * search::kSpeedStep_mps);
  }
}

/// Cells at the suspected speed, with all points; `limit` if they are as many or more. Also `limit`
/// if the speed is rest or no minimum: if the speed a step slower has as few cells or fewer. In a
/// tunnel or along a rail in fog the limit of the view moves with the sensor, and the nearer a
/// speed is to rest, the more cells the scans share. Everything that is fixed makes a minimum at
/// the true speed.
int MotionCheck::occupied_at_suspected(const Eigen::Vector2d& axis, int limit) {
  const double speed_mps = suspected_mps_->dot(axis);
  if (std::abs(speed_mps) < 0.5 * search::kSpeedStep_mps) return limit;
  const int cells = scans_.occupied_at(speed_mps, axis, Subsample::all, grid_, limit);
  if (cells == limit) return limit;
  const double slower_mps = speed_mps - std::copysign(search::kSpeedStep_mps, speed_mps);
  const int slower = scans_.occupied_at(slower_mps, axis, Subsample::all, grid_, cells + 1);
  return slower > cells ? cells : limit;
}

bool MotionCheck::is_clearly_better(const Eigen::Vector2d& axis) {
  // A motion that is clearly better with all points is mostly better with a quarter of them too.
  const Eigen::Vector2d as_tracked = Eigen::Vector2d::Zero();
  const int of_quarter = scans_.occupied_under(as_tracked, Subsample::quarter, grid_);
  suspect_speed(axis, of_quarter);
  if (!suspected_mps_ && least_occupied(axis, Subsample::quarter, of_quarter) == of_quarter) {
    return false;
  }
  const int tracked = scans_.occupied_under(as_tracked, Subsample::all, grid_);
  int least = least_occupied(axis, Subsample::all, tracked);
  if (suspected_mps_) least = occupied_at_suspected(axis, least);
  const int alone = scans_.occupied_alone(grid_);
  // The true motion lays much of the scans on each other. On bare hills a false one lays some:
  // rings meet steep ground at the same ranges from scan to scan, as though it moved with the
  // sensor. Scans that hardly have cells in common tell nothing: then the number of all cells
  // counts. The best of 28 false motions may be two sigmas better by chance.
  return alone - least > search::kLeastShared * alone &&
         is_significant(alone - least, alone - tracked, search::kPreferSigmas) &&
         tracked - least > search::kDropSigmas * std::sqrt(static_cast<double>(tracked));
}

bool MotionCheck::compare(const Eigen::Vector2d& axis) {
  if (!scans_.is_full()) return false;
  times_refuted_ = is_clearly_better(axis) ? times_refuted_ + 1 : 0;
  return times_refuted_ >= search::kRefutingScans;
}

void MotionCheck::observe_ambiguity(const Eigen::Vector2d& axis, bool is_dead_reckoned) {
  if (is_dead_reckoned && is_ambiguous()) ++dead_reckoned_scans_;
  if (!newest_has_structure()) {
    ambiguity_ -= search::kAmbiguitySmoothing * ambiguity_;
  } else if (newest_is_spaced() && spaced_scans_.is_full()) {
    ambiguity_ += search::kAmbiguitySmoothing * (depth_of_second_minimum(axis) - ambiguity_);
  }
}

/// Of the cells occupied over the speed along the axis, forwards and backwards from the tracked
/// motion, in sigmas of that count: how far it falls from the highest value before. Negative where
/// it only rises.
double MotionCheck::depth_of_second_minimum(const Eigen::Vector2d& axis) {
  const double tracked =
      spaced_scans_.occupied_under(Eigen::Vector2d::Zero(), Subsample::all, grid_);
  // Where scans hardly share cells the number varies by chance.
  const double alone = spaced_scans_.occupied_alone(grid_);
  if (alone - tracked <= search::kLeastShared * alone) return 0.0;
  double deepest = -std::numeric_limits<double>::max();
  for (const double direction : {-1.0, 1.0}) {
    double highest = tracked;
    for (int step = 1; step <= search::kAmbiguitySteps; ++step) {
      const Eigen::Vector2d faster_mps = direction * step * search::kAmbiguityStep_mps * axis;
      const double occupied = spaced_scans_.occupied_under(faster_mps, Subsample::all, grid_);
      deepest = std::max(deepest, highest - occupied);
      highest = std::max(highest, occupied);
    }
  }
  return deepest / std::sqrt(tracked);
}

}  // namespace lilo::core
