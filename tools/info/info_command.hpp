// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace lilo {

/// `lilo info`: what a recording holds.
void add_info_command(CLI::App& app);

}  // namespace lilo
