#include "tools/run/run_command.hpp"

#include "tools/bench/benchmark_set.hpp"
#include "tools/plot/trajectory_view.hpp"
#include "tools/progress_bar.hpp"
#include "tools/run/odometry_run.hpp"
#include "tools/run/pose_log.hpp"
#include "tools/run/run_report.hpp"
#include "tools/text_file.hpp"
#include "tools/tool_config.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

namespace lilo {
namespace {

struct RunOptions {
  std::string input, config, profile, sensor;
  std::string tum, kitti, poses, stats, picture, truth, title;
};

/// A result that cannot be written is better known before the work than after it.
void try_outputs(const RunOptions& options) {
  for (const std::string* path : {&options.tum, &options.kitti, &options.stats, &options.picture}) {
    if (!path->empty()) (void)create_text(*path);
  }
}

OdometryRun run_with_progress(ScanSource& source, const Config& config, MapPoints* map,
                              PoseLog* log) {
  ProgressBar bar;
  std::size_t scans = 0;
  return run_odometry(source, config.odometry, [&](const Scan& scan, const Estimate& estimate) {
    ++scans;
    if (log != nullptr) log->add(scan, estimate);
    if (map != nullptr) map->add(scan, estimate.T_odom_sensor);
    if (bar.due()) bar.show(source.progress(), fmt::format("{} scans", scans));
  });
}

void write_picture(const RunOptions& options, const OdometryRun& run, const MapPoints& map) {
  const Trajectory estimate{.name = "estimate", .has_times = true, .poses = run.poses};
  std::optional<Trajectory> truth;
  if (!options.truth.empty()) truth = read_truth(options.truth);
  const std::string file_name = std::filesystem::path(options.input).filename().string();
  const std::string& title = options.title.empty() ? file_name : options.title;
  draw(trajectory_view(title, {estimate}, truth, map)).save(options.picture);
}

void write_results(const RunOptions& options, const OdometryRun& run, const MapPoints& map) {
  if (!options.tum.empty()) write_tum(options.tum, run.poses);
  if (!options.kitti.empty()) write_kitti(options.kitti, run.poses);
  if (!options.stats.empty()) {
    std::ofstream file = create_text(options.stats);
    file << to_json(run);
    finish_text(file, options.stats);
  }
  if (!options.picture.empty()) write_picture(options, run, map);
}

void run_run(const RunOptions& options) {
  const Config config = tool_config(options.config, options.profile, options.sensor);
  const std::unique_ptr<ScanSource> source = open_scans(options.input, config.sensor);
  try_outputs(options);
  std::optional<PoseLog> log;
  if (!options.poses.empty()) log.emplace(options.poses, config.publish);
  MapPoints map;
  const OdometryRun run = run_with_progress(
      *source, config, options.picture.empty() ? nullptr : &map, log ? &*log : nullptr);
  if (log) log->finish();
  write_results(options, run, map);
  if (!run.poses.empty()) fmt::print("{}", to_text(run));
  if (!run.failure.empty()) throw std::runtime_error(run.failure);
  if (run.poses.empty()) {
    throw std::runtime_error(
        fmt::format("{}: expected at least one complete revolution, found none", options.input));
  }
}

}  // namespace

void add_run_command(CLI::App& app) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* sub = app.add_subcommand("run", "Take a recording through the odometry");
  sub->add_option("INPUT", options->input,
                  "pcap (- is standard input), folder of KITTI scans or KITTI sequence")
      ->required();
  sub->add_option("--config", options->config, "YAML configuration; default: what is built in");
  sub->add_option("--profile", options->profile, "Odometry profile, over the configuration's");
  sub->add_option("--sensor", options->sensor, "Sensor model, over the configuration's");
  sub->add_option("--tum", options->tum, "Write the poses: t x y z qx qy qz qw");
  sub->add_option("--kitti", options->kitti, "Write the poses: 12 numbers, sensor frame");
  sub->add_option("--poses", options->poses,
                  "Write what lilod would send, a JSON object a line: status, covariance and all");
  sub->add_option("--stats", options->stats, "Write scans, losses, CPU times, memory as JSON");
  sub->add_option("--picture,--map-png", options->picture, "Draw trajectory and map from above");
  sub->add_option("--truth", options->truth,
                  "True poses for the picture, or the folder of a data set");
  sub->add_option("--title", options->title, "Of the picture");
  sub->callback([options] { run_run(*options); });
}

}  // namespace lilo
