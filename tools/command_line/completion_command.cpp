// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cli.hpp"
#include "tools/command_line/completion.hpp"
#include "tools/command_line/completion_scripts.hpp"

#include <fmt/format.h>

#include <memory>

namespace lilo {

void add_completion_command(CLI::App& app) {
  auto shell = std::make_shared<std::string>();
  CLI::App* sub = app.add_subcommand("completion", "Print the completion script of a shell");
  sub->footer(
      "\nFor this shell: source <(lilo completion bash). The package lilo-tools installs it.");
  sub->add_option("SHELL", *shell, "bash or zsh")
      ->check(one_of({"bash", "zsh"}))
      ->type_name("bash|zsh")
      ->required();
  sub->callback([shell] { fmt::print("{}", *shell == "zsh" ? kZshCompletion : kBashCompletion); });
}

}  // namespace lilo
