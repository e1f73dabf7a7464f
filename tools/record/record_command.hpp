// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace lilo {

/// `lilo record`: what a daemon sends, and the packets it gets, as files.
void add_record_command(CLI::App& app);

}  // namespace lilo
