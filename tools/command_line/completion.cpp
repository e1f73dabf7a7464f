// SPDX-License-Identifier: BSD-3-Clause
#include "tools/command_line/completion.hpp"

#include "tools/command_line/walk.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lilo {
namespace {

using Candidate = Completion::Candidate;

/// Choices are in the name of an option's type: "map|trajectory".
std::vector<Candidate> choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  if (type.find('|') == std::string::npos) return {};
  std::vector<Candidate> out;
  for (const std::string& word : CLI::detail::split(type, '|')) out.push_back({word, ""});
  return out;
}

/// The value of an option or a positional: one of its choices, else a file.
void add_values(const CLI::Option& option, Completion& out) {
  const std::vector<Candidate> choices = choices_of(option);
  out.candidates.insert(out.candidates.end(), choices.begin(), choices.end());
  const std::string type = option.get_type_name();
  const bool number = type == "UINT" || type == "INT" || type == "FLOAT" || type == "NUMBER" ||
                      type.find("..") != std::string::npos;  // "0..60"
  out.files = out.files || (choices.empty() && !number);
}

void add_options(const CLI::App& app, Completion& out) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    for (const std::string& name : option->get_lnames())
      out.candidates.push_back({"--" + name, option->get_description()});
  }
}

void add_commands(const CLI::App& app, Completion& out) {
  for (const std::string& name : command_names(app))
    out.candidates.push_back({name, find_command(app, name)->get_description()});
}

void add_positionals(const CLI::App& app, Completion& out) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) add_values(*option, out);
  }
}

/// Where the words before the last one lead, and the option whose value comes next, if any.
struct Place {
  const CLI::App* command;
  const CLI::Option* open = nullptr;
};

Place follow(const CLI::App& app, const std::vector<std::string>& words) {
  Place place{&app};
  for (std::size_t k = 0; k + 1 < words.size(); ++k) {
    const std::string& word = words[k];
    if (place.open != nullptr) {
      place.open = nullptr;
    } else if (word.starts_with('-')) {
      const CLI::Option* option = find_option(*place.command, word);
      const bool takes_value = option != nullptr && option->get_items_expected_max() > 0;
      if (takes_value && word.find('=') == std::string::npos) place.open = option;
    } else if (const CLI::App* next = find_command(*place.command, word); next != nullptr) {
      place.command = next;
    }
  }
  return place;
}

}  // namespace

Completion complete(const CLI::App& app, const std::vector<std::string>& words) {
  const std::string typed = words.empty() ? "" : words.back();
  const Place place = follow(app, words);
  Completion out;
  if (place.open != nullptr) {
    add_values(*place.open, out);
  } else if (typed.starts_with('-')) {
    add_options(*place.command, out);
  } else {
    add_commands(*place.command, out);
    add_positionals(*place.command, out);
  }
  std::erase_if(out.candidates,
                [&](const Candidate& each) { return !each.word.starts_with(typed); });
  return out;
}

std::string to_text(const Completion& completion) {
  std::string text;
  for (const Candidate& each : completion.candidates) {
    std::string about = each.about.substr(0, each.about.find('\n'));
    std::replace(about.begin(), about.end(), '\t', ' ');
    text += fmt::format("{}\t{}\n", each.word, about);
  }
  return completion.files ? text + ":files\n" : text;
}

}  // namespace lilo
