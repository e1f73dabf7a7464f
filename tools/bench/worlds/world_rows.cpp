// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/worlds/world_rows.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lilo::worlds {

std::vector<Row> rows_of(const std::vector<Outcome>& outcomes) {
  std::vector<Row> rows;
  for (const Outcome& outcome : outcomes) {
    const Drive& drive = outcome.drive;
    auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& r) {
      return r.world == drive.world.name && r.role == drive.role;
    });
    if (row == rows.end()) {
      rows.push_back({drive.world.name, drive.role, {}, {}});
      row = rows.end() - 1;
    }
    (outcome.trouble.empty() ? row->seeds : row->without).push_back(&outcome);
  }
  return rows;
}

std::vector<double> values(const Row& row, std::size_t variant, const Column& column) {
  std::vector<double> all;
  for (const Outcome* outcome : row.seeds) all.push_back(outcome->figures[variant].*column.value);
  return all;
}

std::string seeds_text(Role role, const std::vector<const Outcome*>& seeds) {
  std::string text = to_string(role);
  for (const Outcome* outcome : seeds) {
    text += outcome->drive.seed ? fmt::format(" {}", *outcome->drive.seed) : ", recorded";
  }
  return text;
}

}  // namespace lilo::worlds
