// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/bench/paper/cell_result.hpp"

#include <string>
#include <vector>

namespace lilo::paper_bench {

/// A picture of the report.
struct Chart {
  std::string file;     ///< PNG, in the folder of the report
  std::string title;    ///< "Figure 9a ..."
  std::string caption;  ///< what is seen, and the CSV it was drawn from
};

/// Draws all charts with gnuplot from the CSV files in `folder`: Figure 9a from boxes.csv and
/// box_samples.csv, and for every set Figures 9b/10 (paths) and the errors over distance from
/// tracks/, 11 and 12 from scans/. Throws std::runtime_error.
std::vector<Chart> draw_charts(const std::string& folder, const std::vector<CellResult>& results);

}  // namespace lilo::paper_bench
