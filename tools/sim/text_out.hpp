// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace lilo::sim {

/// Writes a whole file. Throws std::runtime_error naming the file when that fails.
void write_text(const std::string& path, const std::string& text);

}  // namespace lilo::sim
