// SPDX-License-Identifier: BSD-3-Clause
#include "tests/daemon/on_a_terminal.hpp"
#include "tests/daemon/operator.hpp"
#include "tests/tools/temporary_folder.hpp"

#include <filesystem>

/// Completion as a person has it: keys pressed in a shell that has read our script.
namespace lilo {
namespace {

struct Shell {
  const char *name, *path, *before;  // `before`: what makes it complete at all
};

// `lilo` prints the command line instead of running it.
std::string start_up(const Shell& shell) {
  return std::string(shell.before) +
         "\nPS1='ready> '\nPATH=" LILO_BIN_DIR ":$PATH\nsource <(command lilo completion " +
         shell.name +
         ")\n"
         "lilo() { if [[ $1 == complete ]]; then command lilo \"$@\"; else echo \"ran: $*\"; fi; "
         "}\n";
}

class CompletionIn : public testing::TestWithParam<Shell> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(GetParam().path)) GTEST_SKIP() << "no " << GetParam().path;
    folder_.write(".zshrc", start_up(GetParam()));
    folder_.write(".bashrc", start_up(GetParam()));
    folder_.write("a drive.pcap", "");
  }

  std::vector<std::string> words() const {
    if (std::string(GetParam().name) == "zsh") return {"/usr/bin/env", "-C", home(), "zsh", "-i"};
    return {"/usr/bin/env", "-C", home(), "bash", "--rcfile", home() + "/.bashrc", "-i"};
  }
  std::string home() const { return folder_.path(); }

  TemporaryFolder folder_;
};

TEST_P(CompletionIn, FillsInWhatIsMeant) {
  OnATerminal shell(words(), {.rows = 40, .columns = 120}, {{"HOME", home()}, {"ZDOTDIR", home()}});
  ASSERT_NE(shell.until("ready> ").find("ready> "), std::string::npos) << shell.until("ready> ");
  const auto runs = [&](const std::string& keys, const std::string& expected) {
    shell.forget();
    shell.press(keys + "\r");
    const std::string screen = shell.until("ran: " + expected + "\r\n");
    EXPECT_NE(screen.find("ran: " + expected + "\r\n"), std::string::npos) << screen;
  };
  runs("lilo sta\t--j\t", "status --json");
  runs("lilo save t\t", "save trajectory");
  runs("lilo completion z\t", "completion zsh");
  runs("lilo info a\t", "info a drive.pcap");
  runs("lilo status --host h --po\t9", "status --host h --port 9");
}

// Twice Tab in bash, once in zsh, which lists nothing while more keys wait to be read.
TEST_P(CompletionIn, ListsTheChoices) {
  OnATerminal shell(words(), {.rows = 40, .columns = 120}, {{"HOME", home()}, {"ZDOTDIR", home()}});
  ASSERT_NE(shell.until("ready> ").find("ready> "), std::string::npos);
  shell.forget();
  shell.press("lilo re");
  std::string screen;
  for (int tab = 0; tab < 10 && screen.find("reset") == std::string::npos; ++tab) {
    shell.press("\t");
    screen = shell.until("reset", seconds(1));
  }
  for (const char* command : {"record", "replay", "reset"})
    EXPECT_NE(screen.find(command), std::string::npos) << screen;
}

INSTANTIATE_TEST_SUITE_P(Shells, CompletionIn,
                         testing::Values(Shell{"bash", "/bin/bash", ""},
                                         Shell{"zsh", "/usr/bin/zsh",
                                               "autoload -Uz compinit; compinit -u -D"}),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace lilo
