// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/eval_command.hpp"

#include "tools/bench/benchmark_set.hpp"
#include "tools/cli.hpp"
#include "tools/eval/report.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

namespace lilo {
namespace {

struct EvalOptions {
  std::string estimate, truth;
  std::vector<double> lengths_m;
  int step = 10;
  bool json = false;
};

Evaluation evaluation_of(const EvalOptions& options) {
  const Trajectory truth = read_truth(options.truth);
  if (is_pose_stream(options.estimate)) {
    return evaluate(read_pose_stream(options.estimate), truth, options.lengths_m, options.step);
  }
  return evaluate(read_trajectory(options.estimate), truth, options.lengths_m, options.step);
}

void run_eval(const EvalOptions& options) {
  const Evaluation evaluation = evaluation_of(options);
  fmt::print("{}", options.json ? to_json(evaluation) : to_text(evaluation));
}

}  // namespace

void add_eval_command(CLI::App& app) {
  auto options = std::make_shared<EvalOptions>();
  CLI::App* command = app.add_subcommand("eval", "Compare an estimated trajectory with the truth");
  command
      ->add_option("ESTIMATE", options->estimate,
                   "TUM or KITTI poses, or what lilo run --poses or lilo record wrote")
      ->required();
  command
      ->add_option("TRUTH", options->truth,
                   "TUM (matched by time, interpolated) or KITTI (by row) poses, or the "
                   "folder of a data set")
      ->required();
  command
      ->add_option(
          "--lengths", options->lengths_m,
          "Segment lengths in m, comma between; default 100 to 800, shorter on short paths")
      ->delimiter(',')
      ->check(above_zero());
  command->add_option("--step", options->step, "A segment starts at every so many poses")
      ->capture_default_str()
      ->check(above_zero());
  command->add_flag("--json", options->json, "Print one JSON object");
  command->callback([options] { run_eval(*options); });
}

}  // namespace lilo
