// SPDX-License-Identifier: BSD-3-Clause
#include "config/version.hpp"
#include "tools/bench/bench_command.hpp"
#include "tools/command_line/completion.hpp"
#include "tools/command_line/suggestion.hpp"
#include "tools/doctor/doctor_command.hpp"
#include "tools/eval/eval_command.hpp"
#include "tools/info/info_command.hpp"
#include "tools/listen/listen_command.hpp"
#include "tools/plot/plot_command.hpp"
#include "tools/record/record_command.hpp"
#include "tools/replay/replay_command.hpp"
#include "tools/reset/reset_command.hpp"
#include "tools/run/run_command.hpp"
#include "tools/save/save_command.hpp"
#include "tools/sim/sim_command.hpp"
#include "tools/status/status_command.hpp"
#include "tools/top/top_command.hpp"
#include "tools/view/view_command.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

namespace {

constexpr int kFailure = 1;  // the work could not be done: one line on stderr says why
constexpr int kUsage = 2;    // the command line was wrong

void add_commands(CLI::App& app) {
  lilo::add_info_command(app);
  lilo::add_run_command(app);
  lilo::add_eval_command(app);
  lilo::add_bench_command(app);
  lilo::add_plot_command(app);
  lilo::add_replay_command(app);
  lilo::add_sim_command(app);
  lilo::add_view_command(app);
  lilo::add_doctor_command(app);
  lilo::add_status_command(app);
  lilo::add_top_command(app);
  lilo::add_listen_command(app);
  lilo::add_record_command(app);
  lilo::add_reset_command(app);
  lilo::add_save_command(app);
  lilo::add_completion_command(app);
}

int run(int argc, char** argv) {
  CLI::App app{"lilo: the lilod toolbox", "lilo"};
  app.set_version_flag("--version", std::string("lilo ") + lilo::kVersionText);
  app.require_subcommand(1);
  add_commands(app);
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  // Asked by the shells' completion scripts, and not parsed: what comes is no whole command line.
  if (!words.empty() && words.front() == "complete") {
    const std::vector<std::string> typed(words.begin() + 1, words.end());
    std::fputs(lilo::to_text(lilo::complete(app, typed)).c_str(), stdout);
    return 0;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const CLI::RuntimeError& said) {  // a command that has printed why
    return said.get_exit_code();
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "lilo: %s\n", lilo::explain(app, words, error).c_str());
    return kUsage;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lilo: %s\n", error.what());
    return kFailure;
  }
}
