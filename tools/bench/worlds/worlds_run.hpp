// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/bench/worlds/cell.hpp"
#include "tools/bench/worlds/figures.hpp"

#include <optional>
#include <string>
#include <vector>

namespace lilo::worlds {

struct Settings {
  std::vector<Variant> variants;  ///< one, or two to be compared
  Studio studio;
  std::string out;                ///< folder of finished cells
  std::vector<double> lengths_m;  ///< of KITTI segments; empty: as in lilo eval
  unsigned jobs = 1;              ///< drives at a time
};

/// What became of a drive.
struct Outcome {
  Drive drive;
  std::vector<Figures> figures;  ///< by variant; empty where there is `trouble`
  std::string trouble;           ///< one line; empty: none
  bool skipped = false;          ///< the trouble is that it cannot be had here
};

/// Runs every variant over every drive, the variants of a drive one after the other, and says on
/// standard error how far it is. Cells that are in `out` are not run again. Outcomes in the order
/// of `drives`. Throws std::runtime_error, one line: a variant cannot be read, or the work was
/// interrupted.
std::vector<Outcome> run_worlds(const std::vector<Drive>& drives, const Settings& settings);

}  // namespace lilo::worlds
