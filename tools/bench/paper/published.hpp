// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

/// What the LiLO paper printed.
namespace lilo::paper_bench {

/// A row of Table 1, column LiLO.
struct PublishedSequence {
  const char* number;
  double path_m, t_percent, r_deg_per_100m;
};

/// By the name of a set: "00" to "10", "kitti_00" to "kitti_10", or the name of the raw
/// drive a sequence was cut from. None for other sets.
std::optional<PublishedSequence> published_sequence(const std::string& set);

/// Averages of Tables 1 to 3.
inline constexpr double kPublishedMeanT_percent = 0.86, kPublishedMeanR_deg_per_100m = 0.36;
inline constexpr double kPublishedKitti_ms = 78.0;
inline constexpr double kPublishedLoop_ms = 26.9, kPublishedClosure_m = 0.83;

}  // namespace lilo::paper_bench
