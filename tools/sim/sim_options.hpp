// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/options.hpp"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace lilo::sim {

/// What the command line says before it is settled.
struct SimArguments {
  SimOptions options;
  std::string folder;
  std::string start_utc;              ///< seconds, kept as text: a double rounds them
  std::vector<double> robot_boxes_m;  ///< six a box
  double hour_wrap_at_s = -1.0;       ///< negative: not asked for
  bool force = false;                 ///< whatever the folder holds
  bool quiet = false;
};

void add_options(CLI::App& command, SimArguments& arguments);

/// Defaults that depend on other options, and checks across options.
/// Throws CLI::ValidationError naming the option.
void settle(const CLI::App& command, SimArguments& arguments);

/// Throws CLI::ValidationError where something of the user's could be overwritten.
void check_folder(const SimArguments& arguments);

}  // namespace lilo::sim
