// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/config.hpp"

#include <string>

namespace lilo {

/// The configuration as a YAML file that load_config() reads back: every key with its meaning,
/// unit, range, default and whether it can change at run time. The shipped files have this form.
std::string print_config(const Config& config);

/// All keys as one Markdown table per section: config/REFERENCE.md.
std::string print_reference();

}  // namespace lilo
