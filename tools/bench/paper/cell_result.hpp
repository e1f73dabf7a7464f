// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/bench/paper/cell.hpp"

#include <limits>

namespace lilo::paper_bench {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// What a cell brought: one row of cells.csv. Unknown figures are NaN here and empty there. Times
/// are CPU times of the odometry alone, reading and decoding left out.
struct CellResult {
  Cell cell;
  int beams = 0;
  double scans = 0.0;
  double not_tracked = 0.0;       ///< scans said to be degraded or lost
  double path_m = 0.0;            ///< true path
  std::string segment_lengths_m;  ///< "100-800", "100"; empty: the path is too short for the metric
  double segments = 0.0;          ///< how many the errors are a mean of
  double t_percent = kUnknown;    ///< KITTI translation error
  double r_deg_per_100m = kUnknown;    ///< KITTI rotation error
  double ate_m = kUnknown;             ///< absolute trajectory error, rmse
  double edges = 0.0, surfaces = 0.0;  ///< features a scan, mean
  double extraction_ms = 0.0;          ///< projection, filtering, reconstruction; mean
  double pose_ms = 0.0;                ///< deskewing, alignment, map; mean
  double total_ms = 0.0;               ///< mean of a whole scan
  double total_p50_ms = 0.0, total_p99_ms = 0.0, total_max_ms = 0.0;
  double end_x_m = 0.0, end_y_m = 0.0, end_z_m = 0.0;  ///< estimated end, in the first pose's frame
  double true_x_m = 0.0, true_y_m = 0.0, true_z_m = 0.0;  ///< true end

  /// Distance between true start and true end.
  [[nodiscard]] double true_gap_m() const;
  /// The set ends where it began, to 2 % of its path: closure error means something.
  [[nodiscard]] bool is_loop() const;
};

/// Names of the columns of cells.csv.
std::vector<std::string> result_columns();

std::vector<std::string> to_row(const CellResult& result);

/// Throws std::runtime_error when a field is not what result_columns() promises.
CellResult from_row(const std::vector<std::string>& row);

}  // namespace lilo::paper_bench
