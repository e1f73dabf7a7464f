// SPDX-License-Identifier: BSD-3-Clause
#include "tools/command_line/suggestion.hpp"

#include "config/suggest.hpp"
#include "tools/command_line/walk.hpp"

#include <fmt/format.h>

namespace lilo {
namespace {

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = closest_word(word, known);
  return near.empty() ? "" : fmt::format(", did you mean {}?", near);
}

std::string unknown_command(const CLI::App& app, const std::string& word) {
  return fmt::format("{}: no such command{} ({} --help)", word,
                     did_you_mean(word, command_names(app)), full_name(app));
}

std::string unknown_option(const CLI::App& app, const std::string& word) {
  const std::string name = word.substr(0, word.find('='));
  return fmt::format("{}: no such option{} ({} --help)", name,
                     did_you_mean(name, option_names(app)), full_name(app));
}

}  // namespace

std::string explain(const CLI::App& app, const std::vector<std::string>& words,
                    const CLI::ParseError& error) {
  const CLI::App* command = &app;
  for (const std::string& word : words) {
    if (word.starts_with("--") && word.size() > 2) {
      if (find_option(*command, word) == nullptr) return unknown_option(*command, word);
    } else if (!word.starts_with('-') && command->get_require_subcommand_min() > 0) {
      const CLI::App* next = find_command(*command, word);
      if (next == nullptr) return unknown_command(*command, word);
      command = next;
    } else if (const CLI::App* next = find_command(*command, word); next != nullptr) {
      command = next;
    }
  }
  return fmt::format("{} ({} --help)", error.what(), full_name(*command));
}

}  // namespace lilo
