// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace lilo {

/// `lilo plot`: pictures of trajectories, maps and scans.
void add_plot_command(CLI::App& app);

}  // namespace lilo
