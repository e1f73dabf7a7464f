// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace lilo {

/// `lilo sim`: a world, a path and a sensor to a capture with exact truth.
void add_sim_command(CLI::App& app);

}  // namespace lilo
