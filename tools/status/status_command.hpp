// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace lilo {

/// `lilo status`: how a daemon is, on one screen.
void add_status_command(CLI::App& app);

}  // namespace lilo
