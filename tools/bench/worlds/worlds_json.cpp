// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/worlds/comparison.hpp"
#include "tools/bench/worlds/world_rows.hpp"
#include "tools/bench/worlds/worlds_report.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace lilo::worlds {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isnan(value) ? Json() : Json(value); }

Json figures_json(const Row& row, std::size_t variant) {
  Json json;
  for (const Column& column : columns()) {
    const std::vector<double> all = values(row, variant, column);
    const Spread spread = spread_of(all);
    Json& figure = json[column.key];
    figure["mean"] = spread.count > 0 ? Json(spread.mean) : Json();
    figure["deviation"] = spread.count > 1 ? Json(spread.deviation) : Json();
    figure["values"] = Json::array();
    for (const double value : all) figure["values"].push_back(number(value));
  }
  return json;
}

Json differences_json(const Row& row) {
  Json json;
  for (const Column& column : columns()) {
    const Difference d = difference_of(values(row, 0, column), values(row, 1, column));
    json[column.key] = {{"mean", d.count > 0 ? Json(d.mean) : Json()},
                        {"standard_error", d.count > 1 ? Json(d.standard_error) : Json()},
                        {"seeds", d.count},
                        {"beyond_spread", d.beyond_spread}};
  }
  return json;
}

Json row_json(const Row& row) {
  Json json;
  json["world"] = row.world;
  json["role"] = to_string(row.role);
  json["seeds"] = Json::array();
  for (const Outcome* outcome : row.seeds) {
    json["seeds"].push_back(outcome->drive.seed ? Json(*outcome->drive.seed) : Json());
  }
  const std::size_t variants = row.seeds.empty() ? 0 : row.seeds.front()->figures.size();
  json["variants"] = Json::array();
  for (std::size_t v = 0; v < variants; ++v) json["variants"].push_back(figures_json(row, v));
  if (variants == 2) json["differences"] = differences_json(row);
  json["without"] = Json::array();
  for (const Outcome* outcome : row.without) {
    json["without"].push_back({{"seed", outcome->drive.seed ? Json(*outcome->drive.seed) : Json()},
                               {"skipped", outcome->skipped},
                               {"why", outcome->trouble}});
  }
  return json;
}

}  // namespace

std::string to_json(const std::vector<Outcome>& outcomes) {
  Json worlds = Json::array();
  for (const Row& row : rows_of(outcomes)) worlds.push_back(row_json(row));
  return Json{{"worlds", worlds}}.dump(2) + "\n";
}

}  // namespace lilo::worlds
