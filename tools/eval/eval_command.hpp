// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace lilo {

/// `lilo eval`: how far an estimated trajectory is from the truth.
void add_eval_command(CLI::App& app);

}  // namespace lilo
