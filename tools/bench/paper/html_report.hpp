// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/bench/paper/charts.hpp"
#include "tools/csv.hpp"

namespace lilo::paper_bench {

/// A table of the report.
struct ReportTable {
  std::string title, note;
  std::string file;  ///< the same as CSV, line by line
  CsvTable table;
  std::string none = "None.";  ///< in the place of a table without rows
};

/// One HTML page with everything in it: it needs no other file and no network. The first column of
/// a table is the line of its CSV file. Pictures are read from `folder`. Throws std::runtime_error.
std::string html_report(const std::string& folder, const std::string& summary,
                        const std::vector<ReportTable>& tables, const std::vector<Chart>& charts);

/// Text with &, <, > and quotes made harmless.
std::string html_text(const std::string& text);

}  // namespace lilo::paper_bench
