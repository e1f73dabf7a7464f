// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace lilo {

/// `lilo doctor`: whether this computer is ready for a drive.
void add_doctor_command(CLI::App& app);

}  // namespace lilo
