// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace lilo {

/// `lilo run`: a recording through the odometry, as fast as it goes.
void add_run_command(CLI::App& app);

}  // namespace lilo
