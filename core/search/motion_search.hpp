// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/constants.hpp"
#include "core/motion/scan_timing.hpp"
#include "core/motion/trajectory.hpp"
#include "core/search/hypothesis.hpp"
#include "core/search/top_down_grid.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace lilo::core {

/// Searches the constant motion under which a few scans agree best. It needs neither a map nor an
/// initial guess: it tries all motions that a vehicle may have along the ground. Under the true one
/// the structure of the scans shares the most cells.
///
/// Not thread-safe; no allocation after construction.
class MotionSearch {
 public:
  /// What was found. `is_unambiguous`: no other motion fits nearly as well.
  struct Result {
    Twist twist;
    bool moves = false;
    bool is_unambiguous = true;
    /// Only where it moves: whether the scans have a large part of their cells in common under the
    /// best hypothesis. Of thousands of motions one lays some on each other by chance.
    bool shares_enough = false;
  };
  /// Where a scan begins and ends by a track.
  struct Track {
    Pose T_begin, T_end;
  };

  /// `most_features`: of one scan.
  explicit MotionSearch(std::size_t most_features);

  void clear();
  /// The next scan, at most search::kMotionScans.
  void add(const ScanTiming& timing, const std::vector<Feature>& features);

  /// The motion found: stationary, unless another one is significantly better.
  Result find();
  /// The best motion around one that is nearly right.
  Twist refine(const Twist& about, Subsample subsample);
  /// Whether this motion explains all scans probably better than their tracks do.
  bool is_better_than_track(const Twist& twist, std::span<const Track> tracks);

 private:
  struct Scan {
    ScanTiming timing;
    StructurePoints structure;
    TopDownPoints points;  ///< under the turn that was tried last
  };
  [[nodiscard]] std::pair<double, double> since_first(const ScanTiming& timing) const;
  [[nodiscard]] std::span<Scan> scans() { return std::span(scans_).first(count_); }
  [[nodiscard]] int score_of_grid(Subsample subsample) const;
  void turn(const Eigen::Vector3d& angular_radps, Subsample subsample);
  int score_turned(const Twist& twist, Subsample subsample);
  int score(const Twist& twist, Subsample subsample);
  int score_of(std::span<const Track> tracks);
  void try_all();
  void keep_likely();

  std::array<Scan, search::kMotionScans> scans_;
  std::size_t count_ = 0;
  std::array<int, 2> alone_{};  // by Subsample: sum of the cells that each scan alone occupies
  TopDownGrid grid_;
  std::vector<Hypothesis> hypotheses_;
};

/// Whether two motions differ by more than `mps`, or their yaw rates by as much in effect
/// (search::kYawPerSpeed_radpm).
bool differ(const Twist& a, const Twist& b, double mps);

}  // namespace lilo::core
