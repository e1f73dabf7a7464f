// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/bench/paired_run.hpp"

#include <string>
#include <vector>

namespace lilo {

/// For people: a table a set, the two profiles side by side.
std::string to_text(const PairedRun& run);

/// One JSON object {"sets": [...]}; times in ms of CPU, figures unknown are null.
std::string to_json(const std::vector<PairedRun>& runs);

}  // namespace lilo
