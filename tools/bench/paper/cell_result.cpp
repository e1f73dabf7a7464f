// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/paper/cell_result.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

namespace lilo::paper_bench {
namespace {

struct NumberColumn {
  const char* name;
  double CellResult::*value;
};

constexpr std::array kTextColumns = {
    "set",   "beams",  "rows",          "columns",           "ground_filter",
    "group", "deskew", "pixel_centres", "drop_shadow_edges", "segment_lengths_m"};

constexpr std::array<NumberColumn, 21> kNumberColumns = {{
    {"scans", &CellResult::scans},
    {"not_tracked", &CellResult::not_tracked},
    {"path_m", &CellResult::path_m},
    {"segments", &CellResult::segments},
    {"t_percent", &CellResult::t_percent},
    {"r_deg_per_100m", &CellResult::r_deg_per_100m},
    {"ate_m", &CellResult::ate_m},
    {"edges", &CellResult::edges},
    {"surfaces", &CellResult::surfaces},
    {"extraction_ms", &CellResult::extraction_ms},
    {"pose_ms", &CellResult::pose_ms},
    {"total_ms", &CellResult::total_ms},
    {"total_p50_ms", &CellResult::total_p50_ms},
    {"total_p99_ms", &CellResult::total_p99_ms},
    {"total_max_ms", &CellResult::total_max_ms},
    {"end_x_m", &CellResult::end_x_m},
    {"end_y_m", &CellResult::end_y_m},
    {"end_z_m", &CellResult::end_z_m},
    {"true_x_m", &CellResult::true_x_m},
    {"true_y_m", &CellResult::true_y_m},
    {"true_z_m", &CellResult::true_z_m},
}};

double number_of(const std::string& text) {
  if (text.empty()) return kUnknown;
  std::size_t used = 0;
  const double value = std::stod(text, &used);
  if (used != text.size()) throw std::invalid_argument(text);
  return value;
}

/// The value whose name `text` is, of all values of an enumeration.
template <typename Enum, std::size_t N>
Enum value_of(const std::string& text, const std::array<Enum, N>& all) {
  for (const Enum value : all) {
    if (text == to_string(value)) return value;
  }
  throw std::invalid_argument(text);
}

CellResult parse(const std::vector<std::string>& row) {
  CellResult result;
  result.cell.set = row[0];
  result.beams = std::stoi(row[1]);
  result.cell.rows = std::stoi(row[2]);
  result.cell.columns = std::stoi(row[3]);
  result.cell.ground_filter =
      value_of(row[4], std::array{GroundFilter::sobel, GroundFilter::fourier});
  result.cell.group =
      value_of(row[5], std::array{FeatureGroup::EG, FeatureGroup::ES, FeatureGroup::EGS});
  result.cell.deskew =
      value_of(row[6], std::array{Deskew::none, Deskew::one_stage, Deskew::two_stage});
  result.cell.pixel_centres = row[7] == "yes";
  result.cell.drop_shadow_edges = row[8] == "yes";
  result.segment_lengths_m = row[9];
  for (std::size_t k = 0; k < kNumberColumns.size(); ++k) {
    result.*kNumberColumns[k].value = number_of(row[kTextColumns.size() + k]);
  }
  return result;
}

}  // namespace

double CellResult::true_gap_m() const { return std::hypot(true_x_m, true_y_m, true_z_m); }

bool CellResult::is_loop() const { return path_m > 0.0 && true_gap_m() <= 0.02 * path_m; }

std::vector<std::string> result_columns() {
  std::vector<std::string> columns(kTextColumns.begin(), kTextColumns.end());
  for (const NumberColumn& column : kNumberColumns) columns.emplace_back(column.name);
  return columns;
}

std::vector<std::string> to_row(const CellResult& result) {
  const Cell& cell = result.cell;
  std::vector<std::string> row = {cell.set,
                                  fmt::format("{}", result.beams),
                                  fmt::format("{}", cell.rows),
                                  fmt::format("{}", cell.columns),
                                  to_string(cell.ground_filter),
                                  to_string(cell.group),
                                  to_string(cell.deskew),
                                  cell.pixel_centres ? "yes" : "no",
                                  cell.drop_shadow_edges ? "yes" : "no",
                                  result.segment_lengths_m};
  for (const NumberColumn& column : kNumberColumns) {
    const double value = result.*column.value;
    row.push_back(std::isnan(value) ? "" : fmt::format("{:.7g}", value));
  }
  return row;
}

CellResult from_row(const std::vector<std::string>& row) {
  const std::size_t expected = kTextColumns.size() + kNumberColumns.size();
  if (row.size() != expected) {
    throw std::runtime_error(fmt::format("expected {} fields, found {}", expected, row.size()));
  }
  try {
    return parse(row);
  } catch (const std::logic_error& error) {  // of std::stod and ours
    throw std::runtime_error(
        fmt::format("expected a row of cells.csv, found '{}' in that of {}", error.what(), row[0]));
  }
}

}  // namespace lilo::paper_bench
