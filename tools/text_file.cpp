// SPDX-License-Identifier: BSD-3-Clause
#include "tools/text_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <system_error>

namespace lilo {
namespace {

std::runtime_error failure(const std::string& path, const char* doing) {
  const std::string reason = std::generic_category().message(errno);
  return std::runtime_error(fmt::format("{}: cannot {}: {}", path, doing, reason));
}

}  // namespace

std::ifstream open_text(const std::string& path) {
  if (std::filesystem::is_directory(path)) {
    throw std::runtime_error(fmt::format("{}: expected a file, found a folder", path));
  }
  std::ifstream file(path);
  if (!file) throw failure(path, "read");
  return file;
}

std::ofstream create_text(const std::string& path) {
  std::ofstream file(path);
  if (!file) throw failure(path, "write");
  return file;
}

void finish_text(std::ofstream& file, const std::string& path) {
  file.flush();
  if (!file) throw failure(path, "write");
}

}  // namespace lilo
