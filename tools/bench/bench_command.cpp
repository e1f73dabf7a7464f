// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/bench_command.hpp"

#include "tools/bench/paired_report.hpp"
#include "tools/bench/paper/paper_bench.hpp"
#include "tools/bench/worlds/worlds_command.hpp"
#include "tools/cli.hpp"
#include "tools/stop_signals.hpp"
#include "tools/terminal/progress_bar.hpp"
#include "tools/tool_config.hpp"

#include <fmt/format.h>

#include <memory>

namespace lilo {
namespace {

struct BenchOptions {
  std::vector<std::string> paths, paper_paths;
  std::string config, out = "paper-bench";
  std::vector<double> lengths_m;
  std::uint64_t most_scans = 0;
  bool json = false;
};

void run_bench(const BenchOptions& options) {
  const Config config = tool_config(options.config);
  const std::vector<BenchmarkSet> sets = find_sets(options.paths);
  std::vector<PairedRun> runs;
  StopSignals stop;
  for (const BenchmarkSet& set : sets) {
    {
      ProgressBar bar;
      runs.push_back(run_paired(set, config, options.most_scans, [&](double part) {
        if (bar.due()) bar.show({part, 0, set.name});
        return !stop.raised();
      }));
    }
    if (!options.json) fmt::print("{}{}", runs.size() > 1 ? "\n" : "", to_text(runs.back()));
    if (stop.raised()) break;
  }
  if (options.json) fmt::print("{}", to_json(runs));
}

void run_paper(const BenchOptions& options) {
  const Config config = tool_config(options.config);
  const paper_bench::Settings settings{.sensor = config.sensor,
                                       .odometry = config.odometry,
                                       .lengths_m = options.lengths_m,
                                       .most_scans = options.most_scans};
  paper_bench::run_paper_bench(find_sets_with_truth(options.paper_paths), settings, options.out);
}

constexpr const char* kSets =
    "Folders with data.pcap and gt_end.tum, KITTI sequences or raw drives, folders of such";

void add_paper_command(CLI::App& bench, const std::shared_ptr<BenchOptions>& options) {
  CLI::App* sub = bench.add_subcommand(
      "paper", "Repeat the experiments of the LiLO paper: tables, charts, one HTML page");
  sub->add_option("DIR", options->paper_paths, kSets)->required();
  sub->add_option("--out", options->out, "Folder to fill; finished cells in it are not run again")
      ->capture_default_str();
  sub->add_option("--config", options->config, "YAML configuration; cells override what they try");
  sub->add_option("--lengths", options->lengths_m, "Segment lengths in m; default as in lilo eval")
      ->delimiter(',')
      ->check(above_zero());
  sub->add_option("--scans", options->most_scans, "Only so many scans of every set");
  sub->callback([options] { run_paper(*options); });
}

}  // namespace

void add_bench_command(CLI::App& app) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* sub = app.add_subcommand("bench", "Measure both profiles side by side");
  sub->require_subcommand(0, 1);
  sub->add_option("DIR", options->paths, std::string(kSets) + ", captures");
  sub->add_option("--config", options->config, "YAML configuration; default: what is built in");
  sub->add_option("--scans", options->most_scans, "Only so many scans of every set");
  sub->add_flag("--json", options->json, "Print one JSON object");
  add_paper_command(*sub, options);
  add_worlds_command(*sub);
  sub->callback([options, sub] {
    if (!sub->get_subcommands().empty()) return;
    if (options->paths.empty()) throw CLI::RequiredError("bench: DIR");
    run_bench(*options);
  });
}

}  // namespace lilo
