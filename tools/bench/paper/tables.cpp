// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/paper/tables.hpp"

#include "tools/bench/paper/published.hpp"
#include "tools/run/statistics.hpp"

#include <fmt/format.h>

#include <cmath>

namespace lilo::paper_bench {
namespace {

std::string number(double value, int decimals) {
  return std::isnan(value) ? "" : fmt::format("{:.{}f}", value, decimals);
}

std::string lengths_text(const CellResult& result) {
  if (result.segment_lengths_m.empty()) return "too short for the metric";
  return result.segment_lengths_m + " m";
}

std::vector<CellResult> chosen(const Results& results) {
  std::vector<CellResult> rows;
  for (const CellResult& result : results) {
    if (result.cell == chosen_cell(result.cell.set, result.beams)) rows.push_back(result);
  }
  return rows;
}

double mean_of(const Results& results, double CellResult::*figure) {
  std::vector<double> known;
  for (const CellResult& result : results) {
    if (!std::isnan(result.*figure)) known.push_back(result.*figure);
  }
  return known.empty() ? kUnknown : statistics(known).mean;
}

std::vector<std::string> sequence_row(const CellResult& result) {
  const auto paper = published_sequence(result.cell.set);
  return {result.cell.set,
          image_text(result.cell),
          to_string(result.cell.group),
          to_string(result.cell.ground_filter),
          number(result.path_m, 1),
          lengths_text(result),
          number(result.t_percent, 2),
          paper ? number(paper->t_percent, 2) : "",
          number(result.r_deg_per_100m, 2),
          paper ? number(paper->r_deg_per_100m, 2) : "",
          number(result.ate_m, 3),
          number(result.total_ms, 1),
          "",  // the paper has no times of single sequences
          paper ? number(paper->path_m, 0) : ""};
}

/// What the row changes of the chosen cell.
std::string change_text(const CellResult& result) {
  const Cell base = chosen_cell(result.cell.set, result.beams);
  const Cell& cell = result.cell;
  std::string text;
  const auto add = [&text](const std::string& what) { text += (text.empty() ? "" : ", ") + what; };
  if (cell.rows != base.rows) add("no interpolation");
  if (cell.columns != base.columns) add(fmt::format("{} columns", cell.columns));
  if (cell.group != base.group) add(fmt::format("group {}", to_string(cell.group)));
  if (cell.ground_filter != base.ground_filter) {
    add(fmt::format("ground by {}", to_string(cell.ground_filter)));
  }
  if (cell.deskew == Deskew::one_stage) add("one-stage deskewing");
  if (cell.deskew == Deskew::none) add("no deskewing");
  if (cell.pixel_centres) add("points at pixel centres");
  if (!cell.drop_shadow_edges) add("edges on both sides of a jump");
  return text.empty() ? "the paper's choice" : text;
}

}  // namespace

CsvTable table_1(const Results& results) {
  CsvTable table{{"set", "image", "group", "filter", "path_m", "segments", "t_percent",
                  "paper_t_percent", "r_deg_per_100m", "paper_r_deg_per_100m", "ate_m", "time_ms",
                  "paper_time_ms", "paper_path_m"},
                 {}};
  const Results rows = chosen(results);
  for (const CellResult& result : rows) table.rows.push_back(sequence_row(result));
  if (rows.empty()) return table;
  table.rows.push_back(
      {"mean", "", "", "", "", "", number(mean_of(rows, &CellResult::t_percent), 2),
       number(kPublishedMeanT_percent, 2), number(mean_of(rows, &CellResult::r_deg_per_100m), 2),
       number(kPublishedMeanR_deg_per_100m, 2), number(mean_of(rows, &CellResult::ate_m), 3),
       number(mean_of(rows, &CellResult::total_ms), 1), number(kPublishedKitti_ms, 1), ""});
  return table;
}

CsvTable table_3(const Results& results) {
  CsvTable table{{"loop", "image", "group", "filter", "path_m", "time_ms", "x_m", "y_m", "z_m",
                  "d_m", "true_gap_m"},
                 {}};
  double distance_sum = 0.0, time_sum = 0.0;
  for (const CellResult& r : chosen(results)) {
    if (!r.is_loop()) continue;
    const double x = r.end_x_m - r.true_x_m, y = r.end_y_m - r.true_y_m, z = r.end_z_m - r.true_z_m;
    const double d = std::hypot(x, y, z);
    distance_sum += d;
    time_sum += r.total_ms;
    table.rows.push_back({r.cell.set, image_text(r.cell), to_string(r.cell.group),
                          to_string(r.cell.ground_filter), number(r.path_m, 1),
                          number(r.total_ms, 1), number(x, 2), number(y, 2), number(z, 2),
                          number(d, 2), number(r.true_gap_m(), 2)});
  }
  if (table.rows.empty()) return table;
  const auto count = static_cast<double>(table.rows.size());
  table.rows.push_back({"mean", "", "", "", "", number(time_sum / count, 1), "", "", "",
                        number(distance_sum / count, 2), ""});
  table.rows.push_back({"the paper's mean", "32x720", "ES", "fourier", "",
                        number(kPublishedLoop_ms, 1), "", "", "", number(kPublishedClosure_m, 2),
                        ""});
  return table;
}

CsvTable table_of_choices(const Results& results) {
  CsvTable table{
      {"set", "image", "group", "filter", "change", "t_percent", "r_deg_per_100m", "ate_m", "edges",
       "surfaces", "extraction_ms", "pose_ms", "time_ms", "not_tracked"},
      {}};
  for (const CellResult& r : results) {
    table.rows.push_back({r.cell.set, image_text(r.cell), to_string(r.cell.group),
                          to_string(r.cell.ground_filter), change_text(r), number(r.t_percent, 2),
                          number(r.r_deg_per_100m, 2), number(r.ate_m, 3), number(r.edges, 0),
                          number(r.surfaces, 0), number(r.extraction_ms, 2), number(r.pose_ms, 1),
                          number(r.total_ms, 1), number(r.not_tracked, 0)});
  }
  return table;
}

}  // namespace lilo::paper_bench
