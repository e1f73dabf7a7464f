// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/constants.hpp"
#include "core/search/motion_search.hpp"
#include "core/tracking/local_odometry.hpp"
#include "core/tracking/observation.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace lilo::core {

/// Finds the initial motion of the sensor when a map is begun.
///
/// One scan alone does not tell the motion, and is distorted by it. Two scans mostly do:
/// MotionSearch finds the motion under which they agree best. It is refined by aligning the second
/// scan with the first, until the motion found is the motion assumed. Where another motion fits
/// nearly as well, as on a road with little beside it, more scans decide, and the map is begun
/// again if they contradict:
///
///     1st scan      becomes the map
///     2nd           motion searched and refined; stationary or moving, clear or not
///     3rd to 6th    moving: is another motion better by now? then all scans are replayed with it;
///                   was the map begun under another than the one tracked? then with this one
///     4th           stationary: did it creep after all? then the same
///
/// Not thread-safe; no allocation after construction.
class Initializer {
 public:
  /// `most_features`: of one scan that is aligned; `most_for_map`: of one that enters the map.
  Initializer(std::size_t most_features, std::size_t most_for_map);

  /// Scans remembered, including the newest. 0 before the first one and once the motion is known.
  [[nodiscard]] std::size_t scans() const { return count_; }
  /// Whether the sensor is assumed stationary since the second scan, which is believed at once.
  [[nodiscard]] bool assumes_stationary() const { return assumes_stationary_; }

  /// Whether the last add() began the map again with another motion.
  [[nodiscard]] bool was_replayed() const { return was_replayed_; }

  /// Whether the next scan cannot continue the scans remembered, so that another session begins: it
  /// saw far more than the first one, which was a fragment, or it comes too late.
  [[nodiscard]] bool must_begin_again(const ScanTiming& scan, std::size_t feature_count,
                                      const MotionState& state) const;
  void clear();

  /// Takes the next scan before it is aligned. Begins the map again with another motion, if all
  /// scans agree better under it, or with the tracked one, if the map was begun under one that is
  /// far off it. `all`: the features before selection. `was_lost`: the scan before was not found in
  /// the map. Returns whether the motion is known now: then the scans are forgotten, and this one
  /// can be aligned like any later one.
  bool add(const Observation& scan, const std::vector<Feature>& all, bool was_lost,
           LocalOdometry& local);
  /// Aligns the second scan, after add(). `may_be_stationary`: the sensor may be assumed
  /// stationary, as one that was just switched on.
  Solution align_second(bool may_be_stationary, LocalOdometry& local);
  /// The poses at which the newest scan was tracked.
  void set_track(const Pose& T_begin, const Pose& T_end);

 private:
  struct Remembered {
    ScanTiming timing;
    std::size_t feature_count = 0;  ///< before selection
    std::vector<Feature> for_map, selected;
    bool is_room = false;
    Levels levels = Levels::from_whole;  ///< of the map
  };
  /// A motion to begin with, and the prior of its speed along the ground.
  struct Start {
    Twist twist;  ///< as refined so far
    Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();
    double sigma_mps = 0.0;
    bool moves = false;
  };
  [[nodiscard]] Twist tracked_twist() const;
  [[nodiscard]] double since_first_s(std::size_t k) const;
  void note_track(std::size_t k, const Pose& T_begin, const Pose& T_end);
  static void add_velocity_prior(const Start& start, Prior& prior);
  Start search();
  Start best_start(const Twist& tracked, bool was_lost);
  Solution try_start(const Start& start, LocalOdometry& local);
  Solution refine(Start& start, LocalOdometry& local);
  void replay(Start start, LocalOdometry& local);
  bool recheck_stationary(LocalOdometry& local);
  bool recheck_moving(bool was_lost, LocalOdometry& local);

  std::size_t most_for_map_;
  std::array<Remembered, search::kMotionScans> scans_;
  std::array<MotionSearch::Track, search::kMotionScans> tracks_;  // the newest as predicted
  std::size_t count_ = 0;
  MotionSearch search_;
  bool is_unambiguous_ = false;  // no other motion fits nearly as well
  bool assumes_stationary_ = false;
  bool was_replayed_ = false;
  Twist assumed_;  // under which the map was begun; of a replay, before it was refined
};

}  // namespace lilo::core
