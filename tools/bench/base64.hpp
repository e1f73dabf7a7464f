// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace lilo {

/// RFC 4648, with padding, in one line.
std::string base64(std::string_view bytes);

/// The bytes of such a text, up to the first character that is no digit.
std::string from_base64(std::string_view text);

}  // namespace lilo
