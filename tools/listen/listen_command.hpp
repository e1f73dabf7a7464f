// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace lilo {

/// `lilo listen`: prints the poses lilod sends.
void add_listen_command(CLI::App& app);

}  // namespace lilo
