// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/bench/worlds/worlds_run.hpp"

#include <string>
#include <vector>

namespace lilo::worlds {

/// One line a world and role of seeds: means over its seeds, "+-" the standard deviation over them.
/// With two variants one table each, and a third of their differences, seed by seed; what is beyond
/// the spread (comparison.hpp) has a star. Then what was skipped or failed, and why.
std::string to_text(const std::vector<Outcome>& outcomes);

/// One JSON object: {"worlds": [...]}, each with role, seeds, and by variant figures with mean,
/// deviation and the values by seed; with two variants also "differences". Unknown figures are
/// null.
std::string to_json(const std::vector<Outcome>& outcomes);

}  // namespace lilo::worlds
