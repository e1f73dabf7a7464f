// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/text_out.hpp"

#include <fmt/format.h>

#include <fstream>
#include <stdexcept>

namespace lilo::sim {

void write_text(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(fmt::format("{}: cannot be written", path));
}

}  // namespace lilo::sim
