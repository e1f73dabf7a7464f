// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/paper/box.hpp"
#include "tools/bench/paper/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace lilo::paper_bench {
namespace {

struct Measure {
  const char* name;
  double CellResult::*value;
};

constexpr std::array<Measure, 3> kMeasures = {{{"t_percent", &CellResult::t_percent},
                                               {"r_deg_per_100m", &CellResult::r_deg_per_100m},
                                               {"total_ms", &CellResult::total_ms}}};

constexpr std::array kColumns = {360, 720, 1024};
constexpr std::array kGroups = {FeatureGroup::EG, FeatureGroup::ES, FeatureGroup::EGS};

/// Part of the grid of Figure 9a: the chosen cell but for width and group.
bool in_grid(const CellResult& result) {
  Cell cell = chosen_cell(result.cell.set, result.beams);
  cell.columns = result.cell.columns;
  cell.group = result.cell.group;
  return cell == result.cell;
}

struct Sample {
  std::string set;
  double value;
};

/// One box of the figure.
struct Place {
  int rows, columns;
  FeatureGroup group;
  int x;  // 1 to 9, left to right
  Measure measure;
  std::vector<Sample> samples;
};

std::vector<Sample> samples_of(const Results& results, const Place& place) {
  std::vector<Sample> samples;
  for (const CellResult& r : results) {
    const Cell& cell = r.cell;
    const bool here = cell.rows == place.rows && cell.columns == place.columns &&
                      cell.group == place.group && in_grid(r);
    const double value = r.*place.measure.value;
    if (here && !std::isnan(value)) samples.push_back({cell.set, value});
  }
  return samples;
}

/// All boxes that have at least one sample.
std::vector<Place> places(const Results& results) {
  std::set<int> heights;
  for (const CellResult& result : results) {
    if (in_grid(result)) heights.insert(result.cell.rows);
  }
  std::vector<Place> all;
  for (const int rows : heights) {
    for (const Measure& measure : kMeasures) {
      int x = 0;
      for (const int columns : kColumns) {
        for (const FeatureGroup group : kGroups) {
          Place place{rows, columns, group, ++x, measure, {}};
          place.samples = samples_of(results, place);
          if (!place.samples.empty()) all.push_back(place);
        }
      }
    }
  }
  return all;
}

Box box_at(const Place& place) {
  std::vector<double> values;
  for (const Sample& sample : place.samples) values.push_back(sample.value);
  return box_of(values);
}

std::vector<std::string> key_of(const Place& place) {
  return {fmt::format("{}", place.rows), fmt::format("{}", place.x),
          fmt::format("{}x{} {}", place.rows, place.columns, to_string(place.group)),
          place.measure.name};
}

}  // namespace

CsvTable boxes(const Results& results) {
  CsvTable table{
      {"rows", "x", "label", "measure", "sets", "low", "q1", "median", "q3", "high", "mean"}, {}};
  for (const Place& place : places(results)) {
    const Box box = box_at(place);
    table.rows.push_back(key_of(place));
    table.rows.back().push_back(fmt::format("{}", place.samples.size()));
    for (const double value : {box.low, box.q1, box.median, box.q3, box.high, box.mean}) {
      table.rows.back().push_back(fmt::format("{:.6g}", value));
    }
  }
  return table;
}

CsvTable box_samples(const Results& results) {
  CsvTable table{{"rows", "x", "label", "measure", "set", "value", "outlier"}, {}};
  for (const Place& place : places(results)) {
    const Box box = box_at(place);
    for (const Sample& sample : place.samples) {
      const bool outlier = sample.value < box.low || sample.value > box.high;
      table.rows.push_back(key_of(place));
      table.rows.back().insert(
          table.rows.back().end(),
          {sample.set, fmt::format("{:.6g}", sample.value), outlier ? "1" : "0"});
    }
  }
  return table;
}

}  // namespace lilo::paper_bench
