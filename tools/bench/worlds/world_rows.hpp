// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/bench/worlds/worlds_run.hpp"

#include <string>
#include <vector>

namespace lilo::worlds {

/// The outcomes of one world whose seeds have one role.
struct Row {
  std::string world;
  Role role = Role::choose;
  std::vector<const Outcome*> seeds;    ///< those with figures
  std::vector<const Outcome*> without;  ///< skipped or failed
};

/// In the order in which they first occur. The rows point into `outcomes`.
std::vector<Row> rows_of(const std::vector<Outcome>& outcomes);

/// A figure of a variant, seed by seed.
std::vector<double> values(const Row& row, std::size_t variant, const Column& column);

/// "choose 11 12", "choose, recorded".
std::string seeds_text(Role role, const std::vector<const Outcome*>& seeds);

}  // namespace lilo::worlds
