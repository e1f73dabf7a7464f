// SPDX-License-Identifier: BSD-3-Clause
#include "config/print_config.hpp"

#include "config/key.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>

namespace lilo {
namespace {

constexpr std::size_t kLineWidth = 100;

// Words of `text` in lines that start with `margin`.
std::string wrapped(const std::string& text, const std::string& margin) {
  std::istringstream words(text);
  std::string out, line = margin, word;
  while (words >> word) {
    if (line.size() + 1 + word.size() > kLineWidth) {
      out += line + '\n';
      line = margin;
    }
    line += ' ' + word;
  }
  return out + line + '\n';
}

const char* when(Reload reload) {
  return reload == Reload::live ? "Changes on reload." : "Needs a restart.";
}

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 32);
  return text;
}

bool in_section(const Key& key, const Section& section) {
  return key.path.substr(0, key.path.rfind('.')) == section.path;
}

std::string last_name(const std::string& path) { return path.substr(path.rfind('.') + 1); }

// Two spaces for every section around it.
std::string margin_of(const std::string& path) {
  std::string margin;
  for (const char c : path) {
    if (c == '.') margin += "  ";
  }
  return margin;
}

// Names of choices need no quotes.
std::string value_of(const Key& key, const Config& config) {
  const Value value = key.get(config);
  return key.type == KeyType::choice ? std::get<std::string>(value) : to_yaml(value);
}

}  // namespace

std::string print_config(const Config& config) {
  const Config defaults;
  std::string out;
  for (const Section& section : config_sections()) {
    const std::string outer = margin_of(section.path);
    if (!out.empty() && outer.empty()) out += '\n';
    out += wrapped(section.meaning, outer + '#');
    out += fmt::format("{}{}:\n", outer, last_name(section.path));
    for (const Key& key : config_keys()) {
      if (!in_section(key, section)) continue;
      const std::string margin = margin_of(key.path);
      const std::string facts = fmt::format("{}; default {}. {}", capitalised(expected(key)),
                                            value_of(key, defaults), when(key.reload));
      out += wrapped(key.meaning, margin + '#') + wrapped(facts, margin + '#');
      out += fmt::format("{}{}: {}\n", margin, last_name(key.path), value_of(key, config));
    }
  }
  return out;
}

std::string print_reference() {
  const Config defaults;
  std::string out =
      "# Every key of the configuration file\n\n"
      "Made by `lilod --print-reference`; a test keeps it equal to the program. "
      "Reload `live`: SIGHUP takes the key over; `restart`: it counts from the next start.\n";
  for (const Section& section : config_sections()) {
    out += fmt::format("\n## {}\n{}\n\n", section.path, section.meaning);
    out += "| Key | Expected | Default | Reload | Meaning |\n|---|---|---|---|---|\n";
    for (const Key& key : config_keys()) {
      if (!in_section(key, section)) continue;
      out += fmt::format("| `{}` | {} | `{}` | {} | {} |\n", last_name(key.path), expected(key),
                         value_of(key, defaults), key.reload == Reload::live ? "live" : "restart",
                         key.meaning);
    }
  }
  return out;
}

}  // namespace lilo
