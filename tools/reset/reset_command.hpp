// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace lilo {

/// `lilo reset`: a daemon begins a new session.
void add_reset_command(CLI::App& app);

}  // namespace lilo
