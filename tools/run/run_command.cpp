// SPDX-License-Identifier: BSD-3-Clause
#include "tools/run/run_command.hpp"

#include "drivers/beam_file.hpp"
#include "tools/bench/benchmark_set.hpp"
#include "tools/cli.hpp"
#include "tools/plot/trajectory_view.hpp"
#include "tools/run/map_file.hpp"
#include "tools/run/odometry_run.hpp"
#include "tools/run/pose_log.hpp"
#include "tools/run/run_report.hpp"
#include "tools/run/voxel_map.hpp"
#include "tools/terminal/progress_bar.hpp"
#include "tools/text_file.hpp"
#include "tools/tool_config.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>

namespace lilo {
namespace {

struct RunOptions {
  std::string input, config, profile, sensor;
  std::string tum, kitti, poses, stats, picture, truth, title, map, beams;
  double map_voxel_m = 0.1;
  MapColor map_color = MapColor::height;
};

/// A result that cannot be written is better known before the work than after it.
void try_outputs(const RunOptions& options) {
  for (const std::string* path :
       {&options.tum, &options.kitti, &options.stats, &options.picture, &options.map}) {
    if (!path->empty()) (void)create_text(*path);
  }
}

/// What the file has, if there is one; and whether it can be written.
BeamEstimate begin_beams(const RunOptions& options, const Config& config) {
  if (!estimates_beams(config.odometry)) {
    throw std::runtime_error(
        "--beams: expected profile default with calibrate_beams, no errors are estimated without");
  }
  const bool exists = std::filesystem::exists(options.beams);
  const BeamEstimate kept = exists ? read_beams(options.beams) : BeamEstimate{};
  if (!std::ofstream(options.beams, std::ios::app)) (void)create_text(options.beams);  // says why
  if (!exists) std::filesystem::remove(options.beams);  // the next run could not read it empty
  return kept;
}

/// What is made of every scan besides its pose.
struct Followers {
  std::optional<MapPoints> picture;
  std::optional<PoseLog> log;
  std::optional<VoxelMap> map;
};

OdometryRun run_with_progress(ScanSource& source, const Config& config, const BeamEstimate& kept,
                              Followers& followers) {
  ProgressBar bar;
  std::size_t scans = 0;
  const auto seen = [&](const Scan& scan, const Estimate& estimate) {
    ++scans;
    if (followers.log) followers.log->add(scan, estimate);
    if (followers.picture) followers.picture->add(scan, estimate.T_odom_sensor);
    if (followers.map) followers.map->add(scan, estimate.T_odom_sensor);
    if (bar.due()) bar.show({source.progress(), scans, "scans"});
  };
  return run_odometry(source, config.odometry, seen, kept);
}

void write_picture(const RunOptions& options, const OdometryRun& run, const MapPoints& map) {
  const Trajectory estimate{.name = "estimate", .has_times = true, .poses = run.poses};
  std::optional<Trajectory> truth;
  if (!options.truth.empty()) truth = read_truth(options.truth);
  const std::string file_name = std::filesystem::path(options.input).filename().string();
  const std::string& title = options.title.empty() ? file_name : options.title;
  TopView view = trajectory_view(title, {estimate}, truth, map);
  mark(view.tracks.front(), run.statuses);
  draw(view).save(options.picture);
}

void write_results(const RunOptions& options, const OdometryRun& run, const Followers& followers) {
  if (!options.tum.empty()) write_tum(options.tum, run.poses);
  if (!options.kitti.empty()) write_kitti(options.kitti, run.poses);
  if (!options.stats.empty()) {
    std::ofstream file = create_text(options.stats);
    file << to_json(run);
    finish_text(file, options.stats);
  }
  if (!options.beams.empty() && run.beams.ring_count > 0) {
    std::ofstream file = create_text(options.beams);
    file << beams_yaml(run.beams);
    finish_text(file, options.beams);
  }
  if (followers.picture) write_picture(options, run, *followers.picture);
  if (followers.map) {
    write_map(options.map, followers.map->points(), options.map_color);
    fmt::print("map {}: {} points, one a voxel of {:g} m\n", options.map,
               followers.map->points().size(), followers.map->voxel_m());
  }
}

void run_run(const RunOptions& options) {
  const Config config = tool_config(options.config, options.profile, options.sensor);
  const std::unique_ptr<ScanSource> source = open_scans(options.input, config.sensor);
  const BeamEstimate kept = options.beams.empty() ? BeamEstimate{} : begin_beams(options, config);
  try_outputs(options);
  Followers followers;
  if (!options.poses.empty()) followers.log.emplace(options.poses, config.publish);
  if (!options.picture.empty()) followers.picture.emplace();
  if (!options.map.empty()) followers.map.emplace(options.map_voxel_m);
  const OdometryRun run = run_with_progress(*source, config, kept, followers);
  if (followers.log) followers.log->finish();
  write_results(options, run, followers);
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
  sub->add_option("--profile", options->profile, "Odometry profile, over the configuration's")
      ->type_name(choices(choices_of_key("odometry.profile")));
  sub->add_option("--sensor", options->sensor, "Sensor model, over the configuration's")
      ->type_name(choices(choices_of_key("sensor.model")));
  sub->add_option("--tum", options->tum, "Write the poses: t x y z qx qy qz qw");
  sub->add_option("--kitti", options->kitti, "Write the poses: 12 numbers, sensor frame");
  sub->add_option("--poses", options->poses,
                  "Write what lilod would send, a JSON object a line: status, covariance and all");
  sub->add_option("--stats", options->stats, "Write scans, losses, CPU times, memory as JSON");
  sub->add_option(
      "--beams", options->beams,
      "Begin with the errors of the beams in this file, if there is one, and write there "
      "what was found");
  sub->add_option("--picture,--map-png", options->picture, "Draw trajectory and map from above");
  auto* map = sub->add_option("--map", options->map, "Write the whole drive's map, .ply or .pcd")
                  ->check([](const std::string& path) {
                    return is_map_file(path) ? std::string()
                                             : "expected a file .ply or .pcd, found '" + path + "'";
                  });
  sub->add_option("--map-voxel-m", options->map_voxel_m, "One point of the map a cube of this edge")
      ->capture_default_str()
      ->check(within(0.01, 10.0))
      ->needs(map);
  const std::map<std::string, MapColor> colors{{"height", MapColor::height},
                                               {"intensity", MapColor::intensity}};
  choice(sub->add_option("--map-color", options->map_color, "What its colours tell"), colors)
      ->needs(map);
  sub->add_option("--truth", options->truth,
                  "True poses for the picture, or the folder of a data set");
  sub->add_option("--title", options->title, "Of the picture");
  sub->callback([options] { run_run(*options); });
}

}  // namespace lilo
