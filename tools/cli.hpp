#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace lilo {

/// Option check: a number above zero. CLI11's own says so with 309 digits.
inline CLI::Validator above_zero() {
  return CLI::Validator(
      [](std::string& text) {
        double value = 0.0;
        const bool good = CLI::detail::lexical_cast(text, value) && value > 0.0;
        return good ? std::string() : "expected a number above 0, found '" + text + "'";
      },
      "above 0");
}

}  // namespace lilo
