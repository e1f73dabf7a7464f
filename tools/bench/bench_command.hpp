// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace lilo {

/// `lilo bench`: times of the two profiles, paired; `lilo bench paper`: the paper's experiments;
/// `lilo bench worlds`: many worlds.
void add_bench_command(CLI::App& app);

}  // namespace lilo
