// SPDX-License-Identifier: BSD-3-Clause
#include "config/value.hpp"

#include <fmt/format.h>

namespace lilo {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

struct ToYaml {
  std::string operator()(bool v) const { return v ? "true" : "false"; }
  std::string operator()(std::int64_t v) const { return fmt::format("{}", v); }
  // Ten digits: 5 degrees that went through radians come back as 5.
  std::string operator()(double v) const { return fmt::format("{:.10g}", v); }
  std::string operator()(const std::string& v) const { return quoted(v); }
  std::string operator()(const std::vector<std::string>& v) const {
    std::string out = "[";
    for (const std::string& item : v) {
      if (out.size() > 1) out += ", ";
      out += quoted(item);
    }
    return out + ']';
  }
};

}  // namespace

std::string to_yaml(const Value& value) { return std::visit(ToYaml{}, value); }

}  // namespace lilo
