#pragma once

#include "core/pose.hpp"
#include "core/search/footprint.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace lilo::core {

/// Whether the last scans fall on each other better under another motion than the one tracked.
///
/// Where little stands beside the road, one truck ahead tells more of the way along it than all
/// posts together. When it drives off with the sensor, or without it, the alignment may follow the
/// truck: what the truck tells fits, and what stands is taken for moving. But laid over each other
/// as they were tracked, the scans of half a second then show a trail of everything that stands,
/// and take up less room under another motion, along the road.
///
/// Not thread-safe; no allocation after construction.
class MotionCheck {
 public:
  /// `most_features`: of one scan.
  explicit MotionCheck(std::size_t most_features);

  void clear();
  /// The next scan as it was tracked, `span_s` long.
  void see(const std::vector<Feature>& features, const Pose& T_begin, const Pose& T_end,
           double span_s, std::int64_t end_ns);
  /// Once after each see(). Whether another motion was clearly better, now and the last time.
  /// `axis`: horizontal unit vector along what surrounds the sensor, or across it.
  bool is_refuted(const Eigen::Vector2d& axis);

 private:
  static constexpr std::size_t kScans = 6;
  struct Seen {
    Plan plan;
    Eigen::Vector2d begin_m, end_m;
    double span_s = 0.0;
    std::int64_t end_ns = 0;
  };
  /// Cells taken up under the motion tracked, and the least under others.
  struct Looks {
    int tracked = 0, least = 0;
  };
  void add(const Seen& one, const Eigen::Vector2d& more_mps, Share share);
  int cells_under(const Eigen::Vector2d& more_mps, Share share);
  Looks look(const Eigen::Vector2d& axis, Share share);
  bool is_clearly_better(const Eigen::Vector2d& axis);

  std::array<Seen, kScans> seen_;
  std::size_t count_ = 0, newest_ = 0;
  int refuted_ = 0;  // times on end
  Outline outline_;  // of the newest
  Footprint footprint_;
};

}  // namespace lilo::core
