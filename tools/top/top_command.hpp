// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace lilo {

/// `lilo top`: how a daemon is, live.
void add_top_command(CLI::App& app);

}  // namespace lilo
