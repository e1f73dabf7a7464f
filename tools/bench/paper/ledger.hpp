// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/bench/paper/cell_result.hpp"

namespace lilo::paper_bench {

/// cells.csv: what is done stays done. Every result is on disk before the next cell begins, so
/// work can be broken off at any time and taken up again.
class Ledger {
 public:
  /// Takes up the file, if it is there; a row that was cut off is left out. Throws
  /// std::runtime_error, one line, when the file is none of ours.
  explicit Ledger(std::string path);

  [[nodiscard]] const std::vector<CellResult>& results() const { return results_; }
  [[nodiscard]] const CellResult* find(const Cell& cell) const;
  /// Throws std::runtime_error when the disk is full.
  void add(const CellResult& result);

 private:
  std::string path_;
  std::vector<CellResult> results_;
};

}  // namespace lilo::paper_bench
