// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/registration/solver.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <optional>

namespace lilo::core {

/// What the tall structure of a scan tells of its place. None if a slow sensor's scan did not
/// converge, so that residuals may be large. Of a lost scan all is zero, as of a fast sensor: it
/// may be found elsewhere. So it is in rooms: few are that tall, and no vehicles drive there.
std::optional<TallEquations> tall_equations(const Solution& solution, bool is_lost, bool is_room);

/// What structure taller than any vehicle says of the motion of a slow sensor. Vehicles around it
/// may be most of what it sees, and the alignment may follow them. Then what is taller moves away
/// from its place in the map.
///
/// Not thread-safe; no allocation.
class TallStructure {
 public:
  /// The next scan, at its alignment; none: its residuals tell no place, and what earlier scans
  /// told stays. Of a fast sensor nothing is kept. `is_doubted`: another motion fits, or fitted
  /// better. `end_ns`: of the scan. Where the clock was set back, an older doubt is dropped.
  void observe(const std::optional<TallEquations>& scan, bool is_doubted, std::int64_t end_ns);
  /// On a new map. That there was a doubt stays known.
  void forget_scans();

  /// In kTallScans scans in a row it placed the sensor elsewhere, by more than the noise of cells.
  [[nodiscard]] bool disagrees() const;
  /// The sensor is slow, less than kTraffic_s ago its motion was in doubt, and tall structure does
  /// not confirm it: it is hidden, or tells nothing along some direction.
  [[nodiscard]] bool is_missing() const { return is_missing_; }

 private:
  [[nodiscard]] bool is_elsewhere() const;
  [[nodiscard]] bool confirms() const;

  // Means over the scans, in which newer ones count more: of H x = b, as in TallEquations.
  Eigen::Matrix2d information_ = Eigen::Matrix2d::Zero();
  Eigen::Vector2d gradient_ = Eigen::Vector2d::Zero();
  int scans_elsewhere_ = 0;  // in a row
  bool is_slow_ = false;     // by the last scan that told
  std::optional<std::int64_t> doubted_ns_;
  bool is_missing_ = false;
};

}  // namespace lilo::core
