// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace lilo {

/// `lilo save`: a daemon writes its map or its trajectory.
void add_save_command(CLI::App& app);

}  // namespace lilo
