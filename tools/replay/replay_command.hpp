// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace lilo {

/// `lilo replay`: plays a capture as UDP packets at the sensor's speed.
void add_replay_command(CLI::App& app);

}  // namespace lilo
