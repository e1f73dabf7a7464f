// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace lilo {

/// `lilo view`: shows a running lilod, or a recording, in browsers.
void add_view_command(CLI::App& app);

}  // namespace lilo
