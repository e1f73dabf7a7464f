// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/eval/associate.hpp"

#include <optional>
#include <vector>

/// How good a trajectory is, in the field's usual figures. E_i are estimated poses, G_i true ones,
/// both T_odom_sensor; no figure depends on which frame either trajectory is told in.
namespace lilo {

/// Mean error over KITTI segments.
struct SegmentError {
  double length_m = 0.0;  ///< nominal length; 0 for the mean over all lengths
  int count = 0;
  double t_percent = 0.0;
  double r_deg_per_100m = 0.0;
};

struct SegmentErrors {
  std::vector<SegmentError> per_length;  ///< those lengths with at least one segment
  std::optional<SegmentError> overall;   ///< mean over all segments; none when no segment fits
};

/// The KITTI odometry devkit's metric. For every `step`-th pose i and every length L, j is the
/// first pose whose true distance travelled is more than L beyond i's. With
///     D = (E_i^-1 E_j)^-1 (G_i^-1 G_j)
/// a segment's errors are |translation of D| / L and |rotation angle of D| / L; the mean is taken
/// over all segments of all lengths. The devkit takes lengths 100, 200 ... 800 m and step 10.
SegmentErrors segment_errors(const Matched& poses, const std::vector<double>& lengths_m, int step);

/// The devkit's lengths that are shorter than the path; for a path below 100 m the same figures
/// divided by ten (10 ... 80 m), below 10 m by a hundred.
std::vector<double> default_lengths_m(double path_m);

struct ErrorSummary {
  double rmse = 0.0, mean = 0.0, max = 0.0;
};

/// Absolute trajectory error in metres: distances between true positions and estimated ones after
/// the rigid motion (no scale) that minimises their squares: Umeyama, PAMI 1991.
ErrorSummary absolute_error_m(const Matched& poses);

/// Relative pose error from each pose to the next: D as above with j = i + 1.
struct RelativeError {
  ErrorSummary translation_m, rotation_deg;
};
RelativeError relative_error(const Matched& poses);

/// The motion from the first pose to the last. On a loop the true distance is zero and the
/// estimate's is the closure error of the literature.
struct Closure {
  double estimate_m = 0.0;  ///< distance from first to last position
  double truth_m = 0.0;
  double error_m = 0.0;  ///< of D with i first and j last
  double error_deg = 0.0;
};
Closure closure(const Matched& poses);

}  // namespace lilo
