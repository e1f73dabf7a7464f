// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/bench/paper/cell_run.hpp"

#include <string>
#include <vector>

namespace lilo::paper_bench {

/// All experiments of the paper on these sets, every one with truth: fills `folder` with cells.csv,
/// scans/, poses/, tracks/, the tables, the charts and report.html. Cells that cells.csv has
/// already are not run again. Throws std::runtime_error, one line: also when it was interrupted,
/// and when the folder was filled with other settings.
void run_paper_bench(const std::vector<BenchmarkSet>& sets, const Settings& settings,
                     const std::string& folder);

/// Makes tables, charts and report out of the results.
void write_report(const std::vector<BenchmarkSet>& sets, const std::vector<CellResult>& results,
                  const std::string& folder);

}  // namespace lilo::paper_bench
