// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace lilo {

/// What other computers have sent, for a terminal: a question mark for each control character
/// (C0, DEL, and C1 in UTF-8), which could move the cursor, change the title or worse.
std::string printable(std::string_view text);

}  // namespace lilo
