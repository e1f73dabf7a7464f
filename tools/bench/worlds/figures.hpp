// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace lilo::worlds {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// What one run over one recording brought. NaN: not known. Definitions: tools/eval.
struct Figures {
  double t_percent = kUnknown, r_deg_per_100m = kUnknown;  ///< KITTI segments
  double ate_m = kUnknown;
  double nees = kUnknown, nees_tracking = kUnknown;
  double tracking_percent = kUnknown, degraded_percent = kUnknown, lost_percent = kUnknown,
         initializing_percent = kUnknown;
  double false_tracking = kUnknown;  ///< poses
  double sessions = kUnknown;
  double cpu_p50_ms = kUnknown, cpu_p99_ms = kUnknown;  ///< a scan, decoding included
  double map_size = kUnknown;  ///< cells, mean over the last tenth of the recording
  double peak_rss_mb = kUnknown;
};

/// For tables, in their order.
struct Column {
  const char* key;      ///< in JSON
  const char* heading;  ///< in text
  double Figures::*value;
  int decimals;
  bool spread;  ///< in text: with that over the seeds
};
const std::array<Column, 15>& columns();

/// Of a finished cell's folder: poses.jsonl, stats.json and truth.tum. `lengths_m` empty: as in
/// lilo eval. Throws std::runtime_error.
Figures read_figures(const std::string& folder, const std::vector<double>& lengths_m);

}  // namespace lilo::worlds
