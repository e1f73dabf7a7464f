// SPDX-License-Identifier: BSD-3-Clause
#include "tools/terminal/paint.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <unistd.h>

namespace lilo {
namespace {

std::string_view variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

Paint::Paint(int descriptor)
    : on_(isatty(descriptor) != 0 && variable("NO_COLOR").empty() && variable("TERM") != "dumb") {}

std::string Paint::operator()(Colour colour, std::string_view text) const {
  // SGR numbers of ECMA-48: green, yellow, red, faint, bold.
  constexpr std::array<int, 6> kNumbers{0, 32, 33, 31, 2, 1};
  if (!on_ || colour == Colour::none || text.empty()) return std::string(text);
  return fmt::format("\033[{}m{}\033[0m", kNumbers[static_cast<std::size_t>(colour)], text);
}

Colour colour_of_status(std::string_view status) {
  if (status == "tracking") return Colour::good;
  if (status == "initializing" || status == "degraded") return Colour::warning;
  return Colour::bad;
}

}  // namespace lilo
