// SPDX-License-Identifier: BSD-3-Clause
#include "tools/terminal/printable.hpp"

#include <cstddef>

namespace lilo {

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t k = 0; k < text.size(); ++k) {
    const auto byte = static_cast<unsigned char>(text[k]);
    const auto next = static_cast<unsigned char>(k + 1 < text.size() ? text[k + 1] : 0);
    const bool is_c1 = byte == 0xC2 && next >= 0x80 && next < 0xA0;
    if (is_c1) ++k;
    out += byte < 0x20 || byte == 0x7F || is_c1 ? '?' : text[k];
  }
  return out;
}

}  // namespace lilo
