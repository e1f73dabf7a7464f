// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace lilo {

/// Where `value` breaks `schema`, one line each; empty when it does not. Knows the part of JSON
/// Schema that protocol.schema.json uses, and refuses keywords it does not know.
std::vector<std::string> violations(const nlohmann::json& schema, const nlohmann::json& value);

/// daemon/protocol.schema.json.
nlohmann::json protocol_schema();

}  // namespace lilo
