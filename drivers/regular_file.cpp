// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/regular_file.hpp"

#include "drivers/packet_source.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace lilo {

std::string read_regular_file(const std::string& path, const std::string& what) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    throw DriverError(path + ": expected a " + what + " file, found " +
                      (error ? error.message() : "no regular file"));
  std::ifstream in(path, std::ios::binary);
  if (!in) throw DriverError(path + ": " + what + " cannot be opened: " + std::strerror(errno));
  constexpr std::size_t kMaxBytes = 1U << 20U;
  std::string text(kMaxBytes, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

}  // namespace lilo
