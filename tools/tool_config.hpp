// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/config.hpp"

#include <string>
#include <vector>

namespace lilo {

/// The configuration a tool was asked for: a YAML file, or what is built in when `file` is empty;
/// then the odometry profile and the sensor model of those names, unless they are empty. Throws
/// std::runtime_error, one line for every mistake.
Config tool_config(const std::string& file, const std::string& profile = {},
                   const std::string& sensor = {});

/// What the key at `path` may be, where it is one of several names.
std::vector<std::string> choices_of_key(const std::string& path);

}  // namespace lilo
