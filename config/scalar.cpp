// SPDX-License-Identifier: BSD-3-Clause
#include "config/scalar.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <regex>

namespace lilo {
namespace {

bool is_number(const Key& key) { return key.type == KeyType::integer || key.type == KeyType::real; }

bool matches(const std::string& text, const char* pattern) {
  return std::regex_match(text, std::regex(pattern, std::regex::icase));
}

// Digits without leading zeros: YAML 1.1 reads 010 as eight, and nobody means eight.
std::optional<Value> parse_integer(const Key& key, const std::string& text) {
  if (!matches(text, "-?(0|[1-9][0-9]*)")) return std::nullopt;
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool inside =
      static_cast<double>(value) >= key.min && static_cast<double>(value) <= key.max;
  if (error != std::errc{} || !inside) return std::nullopt;
  return value;
}

std::optional<Value> parse_real(const Key& key, const std::string& text) {
  if (!matches(text, "-?((0|[1-9][0-9]*)(\\.[0-9]*)?|\\.[0-9]+)(e[+-]?[0-9]+)?")) {
    return std::nullopt;
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || !(value >= key.min && value <= key.max)) return std::nullopt;
  return value;
}

}  // namespace

std::optional<Value> parse_scalar(const Key& key, const std::string& text, bool quoted) {
  switch (key.type) {
    case KeyType::boolean:
      if (quoted || (text != "true" && text != "false")) return std::nullopt;
      return text == "true";
    case KeyType::integer:
      return quoted ? std::nullopt : parse_integer(key, text);
    case KeyType::real:
      return quoted ? std::nullopt : parse_real(key, text);
    case KeyType::choice:
      if (std::find(key.choices.begin(), key.choices.end(), text) == key.choices.end()) {
        return std::nullopt;
      }
      return text;
    case KeyType::text:
    case KeyType::list:
      if (!key.form.valid(text)) return std::nullopt;
      return text;
  }
  return std::nullopt;
}

std::string oddity(const Key& key, const std::string& text, bool quoted) {
  if (!is_number(key)) return {};
  if (quoted) return "text in quotes";
  if (matches(text, "[+-]?0[0-9_]+(\\..*)?")) return "leading zeros";
  if (matches(text, "[+-]?\\.?(nan|inf|infinity)")) return "not finite";
  return {};
}

}  // namespace lilo
