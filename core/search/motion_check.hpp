// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/constants.hpp"
#include "core/search/tracked_scans.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace lilo::core {

/// Whether the last scans agree better, or nearly as well, under another motion than the one
/// tracked.
///
/// Where little structure stands beside a road, a truck ahead has more features that tell the
/// motion along the road than all posts together. The alignment may then follow the truck: the
/// truck fits, and the posts count as moving. But if the scans of the last half second are laid
/// over each other as they were tracked, everything that is fixed leaves a trail, and the scans
/// share more cells under another motion along the road.
///
/// A track may also be wrong by tens of m/s and differ by metres from scan to scan. So constant
/// speeds along the axis, from -40 to 40 m/s, are tested too: an eighth of them with each scan, and
/// again the one that fitted better than the track. Such a speed counts only if scans share more
/// cells under it than under one that is 1 m/s slower, and rest never counts: where everything
/// looks alike, as in a tunnel, scans share the most at rest.
///
/// Between two lanes that move together it is not known which of two motions is the true one. The
/// number of occupied cells over the speed along the road then has a second minimum beside that of
/// the tracked motion. Where everything is fixed it has one minimum, however rough the tracking is.
///
/// Not thread-safe; no allocation after construction.
class MotionCheck {
 public:
  /// `most_features`: of one scan.
  explicit MotionCheck(std::size_t most_features);

  /// Forgets all scans. An ambiguity ends with it (ambiguity_ended()).
  void clear();
  /// The next scan as it was tracked. If its returns were compensated, both poses are the last one.
  /// A scan with less structure than tracking::kMinFeatures, as on bare ground, is left out, and
  /// those before it are forgotten: with a gap between them scans lie on each other under other
  /// motions by chance.
  void add(const std::vector<Feature>& features, const Pose& T_begin, const Pose& T_end,
           const ScanTiming& timing);
  /// To be called once after each add(). Compares the tracked motion with others. Returns whether
  /// another one was significantly better both now and the last time, and scans share enough cells
  /// under it (kLeastShared). `axis`: horizontal unit vector along or across the surroundings.
  bool compare(const Eigen::Vector2d& axis);
  /// To be called once after each compare(). Looks for a second minimum over 16 scans
  /// (kAmbiguityStride); none where they share too few cells, or without structure.
  /// `is_dead_reckoned`: along a direction, during the newest scan.
  void observe_ambiguity(const Eigen::Vector2d& axis, bool is_dead_reckoned);
  /// Whether there has been one for some time.
  [[nodiscard]] bool is_ambiguous() const { return ambiguity_ > search::kAmbiguousSigmas; }
  /// Whether it just ended after kAmbiguousScans or more. How far the sensor came meanwhile is not
  /// known, and the map is that of one of two motions. False if the motion was dead reckoned during
  /// most of these scans, as in a tunnel: the covariance grew.
  [[nodiscard]] bool ambiguity_ended() const { return ambiguity_ended_; }

 private:
  void count_ambiguous_scans();
  [[nodiscard]] bool newest_is_spaced() const {
    return (scan_count_ - 1) % search::kAmbiguityStride == 0;
  }
  [[nodiscard]] bool newest_has_structure() const {
    return structure_.s.size() >= tracking::kMinFeatures;
  }
  int least_occupied(const Eigen::Vector2d& axis, Subsample subsample, int limit);
  void suspect_speed(const Eigen::Vector2d& axis, int of_quarter);
  int occupied_at_suspected(const Eigen::Vector2d& axis, int limit);
  bool is_clearly_better(const Eigen::Vector2d& axis);
  double depth_of_second_minimum(const Eigen::Vector2d& axis);

  TrackedScans scans_, spaced_scans_;             // every scan; one of kAmbiguityStride
  int scan_count_ = 0;                            // since clear()
  int times_refuted_ = 0;                         // on end
  std::optional<Eigen::Vector2d> suspected_mps_;  // a velocity along the axis that may fit better
  double ambiguity_ = 0.0;                        // sigmas
  int ambiguous_scans_ = 0;                       // in a row
  int dead_reckoned_scans_ = 0;                   // of these
  bool ambiguity_ended_ = false;                  // with the newest
  StructurePoints structure_;                     // of the newest
  TopDownGrid grid_;
};

}  // namespace lilo::core
