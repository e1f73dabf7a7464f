// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace lilo {

/// Looking things up in a tree of commands without parsing. Null and empty where there is none.

const CLI::App* find_command(const CLI::App& app, const std::string& name);
/// "--port", "--port=1" or "-p".
const CLI::Option* find_option(const CLI::App& app, const std::string& word);

/// Commands that --help shows.
std::vector<std::string> command_names(const CLI::App& app);
/// "--port" and so on, without those that --help hides.
std::vector<std::string> option_names(const CLI::App& app);
/// "lilo bench worlds".
std::string full_name(const CLI::App& app);

}  // namespace lilo
