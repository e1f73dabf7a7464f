// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace lilo {

/// `lilo bench worlds`: one configuration over many recordings, or two side by side.
void add_worlds_command(CLI::App& bench);

}  // namespace lilo
