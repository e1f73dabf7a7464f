// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace lilo {

/// One line for a command line that could not be parsed: what is wrong, and the command or option
/// that was probably meant. `words` are those behind the program's name, `error` what CLI11 says.
std::string explain(const CLI::App& app, const std::vector<std::string>& words,
                    const CLI::ParseError& error);

}  // namespace lilo
