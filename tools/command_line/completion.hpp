// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace lilo {

/// What the word that is being typed may become.
struct Completion {
  struct Candidate {
    std::string word, about;
  };
  std::vector<Candidate> candidates;
  bool files = false;  ///< names of files too
};

/// `words`: those behind the program's name, the last one (perhaps empty) being typed.
Completion complete(const CLI::App& app, const std::vector<std::string>& words);

/// For the shells' scripts: "word<TAB>about" a line, and ":files".
std::string to_text(const Completion& completion);

/// `lilo completion`: prints the script for a shell.
void add_completion_command(CLI::App& app);

}  // namespace lilo
