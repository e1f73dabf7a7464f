#include "config/version.hpp"
#include "tools/bench/bench_command.hpp"
#include "tools/eval/eval_command.hpp"
#include "tools/info/info_command.hpp"
#include "tools/listen/listen_command.hpp"
#include "tools/plot/plot_command.hpp"
#include "tools/replay/replay_command.hpp"
#include "tools/run/run_command.hpp"
#include "tools/sim/sim_command.hpp"
#include "tools/view/view_command.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <string>

namespace {

constexpr int kFailure = 1;  // the work could not be done: one line on stderr says why
constexpr int kUsage = 2;    // the command line was wrong

int run(int argc, char** argv) {
  CLI::App app{"lilo: the lilod toolbox", "lilo"};
  app.set_version_flag("--version", std::string("lilo ") + lilo::kVersionText);
  app.require_subcommand(1);
  lilo::add_info_command(app);
  lilo::add_run_command(app);
  lilo::add_eval_command(app);
  lilo::add_bench_command(app);
  lilo::add_plot_command(app);
  lilo::add_replay_command(app);
  lilo::add_listen_command(app);
  lilo::add_sim_command(app);
  lilo::add_view_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "lilo: %s (lilo --help)\n", error.what());
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
