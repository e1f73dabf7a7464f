// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/key.hpp"

#include <optional>
#include <string>

namespace lilo {

/// The text of a YAML scalar as the value of a key, or nothing when it is not `expected(key)`.
/// `quoted`: it stood in quotes, so it is text and never a number.
std::optional<Value> parse_scalar(const Key& key, const std::string& text, bool quoted);

/// What is odd about a text that parse_scalar refused, for the end of the error line: "leading
/// zeros", "not finite", or empty when the text speaks for itself.
std::string oddity(const Key& key, const std::string& text, bool quoted);

}  // namespace lilo
