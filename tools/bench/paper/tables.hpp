// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/bench/paper/cell_result.hpp"
#include "tools/csv.hpp"

#include <vector>

/// The paper's tables and figures as numbers. Every row is made of rows of cells.csv: columns set,
/// image, group, filter say of which.
namespace lilo::paper_bench {

using Results = std::vector<CellResult>;

/// Table 1: a set a row, its chosen cell, the paper's figures beside ours, their means last.
CsvTable table_1(const Results& results);

/// Table 3: loops, start to end; empty when no set is one.
CsvTable table_3(const Results& results);

/// What every choice costs and brings: all cells of all sets.
CsvTable table_of_choices(const Results& results);

/// Figure 9a: boxes over all sets of as many beams, by image and group. Columns rows, x (place in
/// the figure), label, measure (t_percent, r_deg_per_100m, total_ms), sets, low ... high, mean.
CsvTable boxes(const Results& results);

/// What the boxes are made of, a sample a row; `outlier` is 1 beyond the whiskers.
CsvTable box_samples(const Results& results);

}  // namespace lilo::paper_bench
