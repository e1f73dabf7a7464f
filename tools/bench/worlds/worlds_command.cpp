// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/worlds/worlds_command.hpp"

#include "tools/bench/worlds/subprocess.hpp"
#include "tools/bench/worlds/worlds_report.hpp"
#include "tools/cli.hpp"
#include "tools/tool_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <thread>
#include <unistd.h>

namespace lilo {
namespace {

struct WorldsOptions {
  std::string list, config, against, only, recordings, seeds = "all", out = "worlds-bench";
  std::string velosim = "../shared/velosim/build/velosim";
  std::vector<double> lengths_m;
  unsigned jobs = std::max(1U, std::thread::hardware_concurrency());
  bool json = false;
};

/// A program is another build with the same configuration, anything else another configuration.
worlds::Variant second_variant(const WorldsOptions& options) {
  const std::string& against = options.against;
  if (std::filesystem::is_regular_file(against) && access(against.c_str(), X_OK) == 0) {
    return {.program = std::filesystem::absolute(against).string(), .config = options.config};
  }
  (void)tool_config(against);  // its mistakes are better known before the work
  return {.program = kOwnProgram, .config = against};
}

worlds::Settings settings_of(const WorldsOptions& options) {
  (void)tool_config(options.config);
  worlds::Settings settings{
      .out = options.out, .lengths_m = options.lengths_m, .jobs = options.jobs};
  settings.variants.push_back({.program = kOwnProgram, .config = options.config});
  if (!options.against.empty()) settings.variants.push_back(second_variant(options));
  settings.studio = {
      .lilo = kOwnProgram,
      .velosim = options.velosim,
      .recordings = options.recordings.empty() ? options.out + "/recordings" : options.recordings};
  std::filesystem::create_directories(options.out + "/cells");
  return settings;
}

std::vector<worlds::Role> roles_of(const std::string& seeds) {
  using worlds::Role;
  if (seeds == "choose") return {Role::choose};
  if (seeds == "report") return {Role::report};
  return {Role::choose, Role::report};
}

void run_worlds(const WorldsOptions& options) {
  const worlds::WorldList list =
      options.list.empty() ? worlds::default_world_list() : worlds::read_world_list(options.list);
  const std::vector<worlds::Drive> drives = drives_of(list, roles_of(options.seeds), options.only);
  if (drives.empty()) {
    throw std::runtime_error(
        fmt::format("{}: expected worlds that --only and --seeds leave, found none",
                    options.list.empty() ? "worlds.yaml" : options.list));
  }
  const std::vector<worlds::Outcome> outcomes = worlds::run_worlds(drives, settings_of(options));
  fmt::print("{}", options.json ? to_json(outcomes) : to_text(outcomes));
  const auto failed = std::count_if(outcomes.begin(), outcomes.end(), [](const worlds::Outcome& o) {
    return !o.trouble.empty() && !o.skipped;
  });
  if (failed > 0) {
    throw std::runtime_error(fmt::format("{} of {} recordings failed", failed, outcomes.size()));
  }
}

void add_choices(CLI::App& sub, WorldsOptions& options) {
  sub.add_option("LIST", options.list, "Worlds and seeds, YAML; default: what is built in");
  sub.add_option("--only", options.only, "Worlds whose name matches this regular expression");
  sub.add_option("--seeds", options.seeds,
                 "Those constants may be chosen on, those that are only reported, or both")
      ->check(one_of({"choose", "report", "all"}))
      ->type_name("choose|report|all")
      ->capture_default_str();
  sub.add_option("--config", options.config,
                 "YAML configuration; the sensor's model is the world's");
  sub.add_option("--against", options.against,
                 "Another configuration, or another build of lilo: compared seed by seed");
}

}  // namespace

void add_worlds_command(CLI::App& bench) {
  auto options = std::make_shared<WorldsOptions>();
  CLI::App* sub = bench.add_subcommand(
      "worlds", "Run many simulated worlds and recordings: errors, trust and times in one table");
  add_choices(*sub, *options);
  sub->add_option("--out", options->out, "Folder to fill; finished cells in it are not run again")
      ->capture_default_str();
  sub->add_option("--recordings", options->recordings,
                  "Keeps what simulators made, as SEED/NAME; default: recordings in --out");
  sub->add_option("--velosim", options->velosim, "Program of source velosim")
      ->capture_default_str();
  sub->add_option("--lengths", options->lengths_m, "Segment lengths in m; default as in lilo eval")
      ->delimiter(',')
      ->check(above_zero());
  sub->add_option("--jobs", options->jobs, "Recordings at a time; default: one a core")
      ->check(above_zero());
  sub->add_flag("--json", options->json, "Print one JSON object");
  sub->callback([options] { run_worlds(*options); });
}

}  // namespace lilo
