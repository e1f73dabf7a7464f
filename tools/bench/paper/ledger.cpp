// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/paper/ledger.hpp"

#include "tools/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace lilo::paper_bench {

Ledger::Ledger(std::string path) : path_(std::move(path)) {
  if (!std::filesystem::exists(path_)) return;
  const CsvTable table = read_csv(path_);
  if (!table.columns.empty() && table.columns != result_columns()) {
    throw std::runtime_error(fmt::format(
        "{}:1: expected the columns of this version, found others: choose another --out", path_));
  }
  for (const std::vector<std::string>& row : table.rows) {
    try {
      results_.push_back(from_row(row));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("{}:{}: {}", path_, results_.size() + 2, error.what()));
    }
  }
}

const CellResult* Ledger::find(const Cell& cell) const {
  const auto found = std::find_if(results_.begin(), results_.end(),
                                  [&](const CellResult& result) { return result.cell == cell; });
  return found == results_.end() ? nullptr : &*found;
}

void Ledger::add(const CellResult& result) {
  results_.push_back(result);
  CsvTable table{result_columns(), {}};
  for (const CellResult& done : results_) table.rows.push_back(to_row(done));
  write_csv(path_, table);
}

}  // namespace lilo::paper_bench
