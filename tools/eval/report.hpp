// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/eval/metrics.hpp"
#include "tools/eval/pose_stream.hpp"
#include "tools/eval/trust.hpp"

#include <optional>
#include <string>
#include <vector>

namespace lilo {

/// Everything `lilo eval` says of a trajectory.
struct Evaluation {
  std::size_t matched = 0, unmatched = 0;
  double estimate_path_m = 0.0, truth_path_m = 0.0;
  int step = 10;
  SegmentErrors segments;
  ErrorSummary absolute_m;
  RelativeError relative;
  Closure closure;
  std::optional<Trust> trust;  ///< none where the estimate says nothing of itself
};

/// `lengths_m` empty: default_lengths_m(). `step` >= 1. Throws std::runtime_error when nothing
/// matches.
Evaluation evaluate(const Trajectory& estimate, const Trajectory& truth,
                    std::vector<double> lengths_m, int step);
/// The same, and what the stream says of itself.
Evaluation evaluate(const PoseStream& estimate, const Trajectory& truth,
                    std::vector<double> lengths_m, int step);

/// For people: one figure a line.
std::string to_text(const Evaluation& evaluation);

/// One JSON object; `t_percent` and `r_deg_per_100m` are null when no segment fits the path.
std::string to_json(const Evaluation& evaluation);

}  // namespace lilo
