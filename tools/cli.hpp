// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/suggest.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace lilo {

/// Option check: a number above zero. CLI11's own says so with 309 digits.
inline CLI::Validator above_zero() {
  return CLI::Validator(
      [](std::string& text) {
        double value = 0.0;
        const bool good =
            CLI::detail::lexical_cast(text, value) && value > 0.0 && std::isfinite(value);
        return good ? std::string() : "expected a number above 0, found '" + text + "'";
      },
      "above 0");
}

/// Option check: a number from `low` to `high`. CLI11's own lets nan pass.
inline CLI::Validator within(double low, double high) {
  return CLI::Validator(
      [low, high](std::string& text) {
        double value = std::numeric_limits<double>::quiet_NaN();
        const bool good = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
        return good ? std::string()
                    : fmt::format("expected a number from {} to {}, found '{}'", low, high, text);
      },
      "");
}

/// Option check: a whole number, not below 0. CLI11's own turns -1 into the largest.
inline CLI::Validator count() {
  return CLI::Validator(
      [](std::string& text) {
        const bool digits = text.find_first_not_of("0123456789") == std::string::npos;
        std::uint64_t value = 0;
        const bool good = !text.empty() && digits && CLI::detail::lexical_cast(text, value);
        return good ? std::string() : "expected a whole number from 0 on, found '" + text + "'";
      },
      "");
}

/// Option check: one of these names. CLI11's own prints its table.
inline CLI::Validator one_of(const std::vector<std::string>& names) {
  return CLI::Validator(
      [names](std::string& text) {
        if (std::find(names.begin(), names.end(), text) != names.end()) return std::string();
        const std::string near = closest_word(text, names);
        return fmt::format("expected one of {}, found '{}'{}", fmt::join(names, ", "), text,
                           near.empty() ? "" : fmt::format(", did you mean {}?", near));
      },
      "");
}

/// "street|park": what the help page and completion know an option's values by.
inline std::string choices(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, "|"));
}

/// An option whose value has one of these names.
template <typename Value>
CLI::Option* choice(CLI::Option* option, const std::map<std::string, Value>& values) {
  std::vector<std::string> names;
  names.reserve(values.size());
  for (const auto& [name, value] : values) names.push_back(name);
  // The last transformation is the first to run.
  return option->transform(CLI::CheckedTransformer(values).description(""))
      ->transform(one_of(names))
      ->type_name(choices(names));
}

}  // namespace lilo
