// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <string>

namespace lilo {

/// Text files whose failures name the file and the system's reason. All throw std::runtime_error.
std::ifstream open_text(const std::string& path);
std::ofstream create_text(const std::string& path);
/// Writes what is still buffered; a full disk is an error here and not a short file.
void finish_text(std::ofstream& file, const std::string& path);

}  // namespace lilo
