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
      const Trajectory estimate = read_trajectory(folder + "/poses/" + stem + ".tum");
      write_csv(folder + "/tracks/" + stem + ".csv",
                error_table(error_track(associate(estimate, *set.truth))));
    }
  }
}

std::vector<ReportTable> tables_of(const std::vector<CellResult>& results) {
  return {
      {"Table 1: errors by sequence",
       fmt::format("The paper's choice of image, group and filter for each sensor. t and r are "
                   "KITTI's segment errors; shaded: what the paper printed for the whole "
                   "sequence, and its mean over KITTI 00 to 10. The paper's mean time is {:g} ms "
                   "(2.6 GHz, one core).",
                   kPublishedKitti_ms),
       "table1.csv", table_1(results)},
      {"Table 3: closure of loops",
       "End of the estimate minus true end, in the frame of the first pose; sets that end where "
       "they began, to 2 % of their path.",
       "table3.csv", table_3(results)},
      {"What each choice costs and brings",
       "Every cell that was run; times are CPU time a scan, features those aligned in a scan.",
       "choices.csv", table_of_choices(results)},
      {"Figure 9a in numbers", "Boxes over the sets with as many image rows.", "boxes.csv",
       boxes(results)}};
}

std::string summary_of(const std::vector<CellResult>& results,
                       const std::vector<BenchmarkSet>& sets) {
  return fmt::format(
      "{} sets, {} experiments with profile paper. Every number stands in a CSV file of the folder "
      "this page was made in; cells.csv has them in full, settings.yaml all that was configured. "
      "Charts are drawn by gnuplot from the .gp files there.",
      sets.size(), results.size());
}

}  // namespace

void write_report(const std::vector<BenchmarkSet>& sets, const std::vector<CellResult>& results,
                  const std::string& folder) {
  write_tracks(sets, results, folder);
  const std::vector<ReportTable> tables = tables_of(results);
  for (const ReportTable& table : tables) write_csv(folder + "/" + table.file, table.table);
  write_csv(folder + "/box_samples.csv", box_samples(results));
  const std::vector<Chart> charts = draw_charts(folder, results);
  const std::string path = folder + "/report.html";
  std::ofstream file = create_text(path);
  file << html_report(folder, summary_of(results, sets), tables, charts);
  finish_text(file, path);
  fmt::print("{}\n", path);
}

}  // namespace lilo::paper_bench
