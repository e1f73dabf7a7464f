// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/paper/html_report.hpp"
#include "tools/bench/paper/paper_bench.hpp"
#include "tools/bench/paper/published.hpp"
#include "tools/bench/paper/tables.hpp"
#include "tools/eval/error_track.hpp"
#include "tools/text_file.hpp"

#include <fmt/format.h>

namespace lilo::paper_bench {
namespace {

/// Estimate beside truth for the charts, of the chosen image with every group.
void write_tracks(const std::vector<BenchmarkSet>& sets, const std::vector<CellResult>& results,
                  const std::string& folder) {
  for (const CellResult& result : results) {
    for (const BenchmarkSet& set : sets) {
      if (set.name != result.cell.set) continue;
      const std::string stem = file_stem(result.cell);
      const Trajectory estimate = read_trajectory(fmt::format("{}/poses/{}.tum", folder, stem));
      write_csv(fmt::format("{}/tracks/{}.csv", folder, stem),
                error_table(error_track(associate(estimate, *set.truth))));
    }
  }
}

CsvTable summary_table(const std::vector<CellResult>& results,
                       const std::vector<BenchmarkSet>& sets) {
  return {{"sets", "experiments"},
          {{fmt::format("{}", sets.size()), fmt::format("{}", results.size())}}};
}

std::vector<ReportTable> tables_of(const std::vector<CellResult>& results,
                                   const std::vector<BenchmarkSet>& sets) {
  return {
      {"Table 1: errors by sequence",
       "The paper's choice of image, group and filter for each sensor. t and r are KITTI's segment "
       "errors; shaded: what the paper printed for the whole sequence, and its means over KITTI 00 "
       "to 10 (on one core of 2.6 GHz).",
       "table1.csv", table_1(results)},
      {"Table 3: closure of loops",
       "End of the estimate minus true end, in the frame of the first pose; sets that end where "
       "they began, to 2 % of their path.",
       "table3.csv", table_3(results),
       "No set here ends where it began, so there is no loop to close. One that does: lilo sim DIR "
       "--world loop --duration-s 80."},
      {"What each choice costs and brings",
       "Every experiment; times are CPU time a scan, features those aligned in a scan. cells.csv "
       "has the same with all decimals.",
       "choices.csv", table_of_choices(results)},
      {"Figure 9a in numbers",
       "Boxes over the sets with as many image rows; box_samples.csv has every set.", "boxes.csv",
       boxes(results)},
      {"What this page is made of", "Number of sets and of experiments with profile paper.",
       "summary.csv", summary_table(results, sets)}};
}

constexpr const char* kSummary =
    "Profile paper on every set, one choice changed at a time. Every number stands in a CSV file "
    "of "
    "the folder this page was made in: below each heading is the file, and in the first column of "
    "a "
    "table the line. cells.csv has all results in full, settings.yaml what was configured. Charts "
    "are drawn by gnuplot from the .gp files there. Times are CPU times of the one thread that "
    "works, reading and decoding left out; they hold against each other, not elsewhere.";

}  // namespace

void write_report(const std::vector<BenchmarkSet>& sets, const std::vector<CellResult>& results,
                  const std::string& folder) {
  write_tracks(sets, results, folder);
  const std::vector<ReportTable> tables = tables_of(results, sets);
  for (const ReportTable& table : tables) write_csv(folder + "/" + table.file, table.table);
  write_csv(folder + "/box_samples.csv", box_samples(results));
  const std::vector<Chart> charts = draw_charts(folder, results);
  const std::string path = folder + "/report.html";
  std::ofstream file = create_text(path);
  file << html_report(folder, kSummary, tables, charts);
  finish_text(file, path);
  fmt::print("{}\n", path);
}

}  // namespace lilo::paper_bench
