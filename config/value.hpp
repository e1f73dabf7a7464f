// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace lilo {

/// What a key can hold, in the units of the YAML file (angles in degrees). Enumerations are text.
using Value = std::variant<bool, std::int64_t, double, std::string, std::vector<std::string>>;

/// The value as YAML: numbers with at most ten digits, text in double quotes, lists in brackets.
std::string to_yaml(const Value& value);

}  // namespace lilo
