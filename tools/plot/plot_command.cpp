// SPDX-License-Identifier: BSD-3-Clause
#include "tools/plot/plot_command.hpp"

#include "drivers/scan_source.hpp"
#include "tools/bench/benchmark_set.hpp"
#include "tools/bench/paper/cell.hpp"
#include "tools/cli.hpp"
#include "tools/eval/associate.hpp"
#include "tools/eval/pose_stream.hpp"
#include "tools/plot/error_chart.hpp"
#include "tools/plot/features_view.hpp"
#include "tools/plot/scan_view.hpp"
#include "tools/plot/trajectory_view.hpp"
#include "tools/terminal/progress_bar.hpp"
#include "tools/tool_config.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

namespace lilo {
namespace {

struct PlotOptions {
  std::vector<std::string> trajectories;
  std::string truth, input, config, title;
  bool features = false, errors = false;
  std::string out = "plot.png";
  std::optional<std::uint64_t> scan;
};

std::string base_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

/// Of a recording: captures in folders of their own are all called data.pcap.
std::string recording_name(const std::string& path) {
  std::string name = base_name(path);
  if (name != "data.pcap") return name;
  return std::filesystem::canonical(path).parent_path().filename().string();
}

std::unique_ptr<ScanSource> open_input(const PlotOptions& options) {
  return open_scans(options.input, tool_config(options.config).sensor);
}

std::optional<Pose> pose_of(const Trajectory& trajectory, const Scan& scan, std::size_t ordinal) {
  if (trajectory.has_times) return pose_at(trajectory.poses, scan.end_ns);
  if (ordinal >= trajectory.poses.size()) return std::nullopt;
  return trajectory.poses[ordinal].pose;
}

MapPoints build_map(ScanSource& source, const Trajectory& trajectory) {
  MapPoints map;
  ProgressBar bar;
  Scan scan;
  for (std::size_t k = 0; source.next(scan); ++k) {
    if (const auto pose = pose_of(trajectory, scan, k)) map.add(scan, *pose);
    if (bar.due()) bar.show({source.progress(), k + 1, "scans"});
  }
  return map;
}

/// Poses, or recorded datagrams.
std::vector<Trajectory> read_estimates(const std::vector<std::string>& files) {
  std::vector<Trajectory> estimates;
  for (const std::string& file : files) {
    estimates.push_back(is_pose_stream(file) ? trajectory(read_pose_stream(file))
                                             : read_trajectory(file));
    estimates.back().name = files.size() == 1 ? "estimate" : base_name(file);
  }
  return estimates;
}

void mark_statuses(const std::string& file, Track& track) {
  std::vector<TrackingStatus> statuses;
  std::vector<int> sessions;
  for (const SaidPose& said : read_pose_stream(file).poses) {
    statuses.push_back(said.status);
    sessions.push_back(said.session);
  }
  mark(track, statuses, sessions);
}

void plot_errors(const PlotOptions& options) {
  const std::string title = options.title.empty() ? "Errors over distance" : options.title;
  draw_errors(read_estimates(options.trajectories), read_truth(options.truth), title, options.out);
}

void plot_trajectories(const PlotOptions& options) {
  const std::vector<Trajectory> estimates = read_estimates(options.trajectories);
  std::optional<Trajectory> truth;
  if (!options.truth.empty()) truth = read_truth(options.truth);
  MapPoints map;
  if (!options.input.empty()) map = build_map(*open_input(options), estimates.front());
  const std::string subject =
      options.input.empty() ? base_name(options.trajectories[0]) : recording_name(options.input);
  const std::string& title = options.title.empty() ? subject : options.title;
  TopView view = trajectory_view(title, estimates, truth, map);
  for (std::size_t k = 0; k < options.trajectories.size(); ++k) {
    if (is_pose_stream(options.trajectories[k]))
      mark_statuses(options.trajectories[k], view.tracks[k]);
  }
  draw(view).save(options.out);
}

/// UTC, or seconds where a data set counts from its own start.
std::string time_text(std::int64_t stamp_ns) {
  constexpr std::int64_t kYear_ns = 365LL * 86400 * 1'000'000'000;
  if (stamp_ns < kYear_ns) return fmt::format("{:.2f} s", static_cast<double>(stamp_ns) * 1e-9);
  const std::time_t seconds = stamp_ns / 1'000'000'000;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  return fmt::format("{:%Y-%m-%d %H:%M:%S}.{:03d} UTC", utc, stamp_ns % 1'000'000'000 / 1'000'000);
}

std::string scan_title(const Scan& scan) {
  return fmt::format("scan {}, {}, {} returns", scan.index, time_text(scan.end_ns),
                     scan.returns.size());
}

/// Without a configuration, what the paper chose for the sensor.
OdometryConfig features_config(const OdometryConfig& config, const Scan& scan, bool choose) {
  if (!choose) return config;
  const int beams = scan.beams.ring_count;
  return paper_bench::odometry_config(paper_bench::chosen_cell("", beams), beams, config);
}

void plot_scan(const PlotOptions& options) {
  const std::unique_ptr<ScanSource> source = open_input(options);
  Scan scan;
  for (std::uint64_t k = 0; k <= *options.scan; ++k) {
    if (!source->next(scan)) {
      throw std::runtime_error(
          fmt::format("{}: expected a scan {}, found {} scans", options.input, *options.scan, k));
    }
  }
  const std::string title = options.title.empty() ? recording_name(options.input) : options.title;
  const std::string words = title + ", " + scan_title(scan);
  if (options.features) {
    const OdometryConfig config = tool_config(options.config).odometry;
    draw_features(scan, features_config(config, scan, options.config.empty()), words)
        .save(options.out);
  } else {
    draw(scan, words).save(options.out);
  }
}

void run_plot(const PlotOptions& options) {
  if (options.scan) {
    plot_scan(options);
  } else if (options.errors) {
    plot_errors(options);
  } else {
    plot_trajectories(options);
  }
  fmt::print("{}\n", options.out);
}

}  // namespace

void add_plot_command(CLI::App& app) {
  auto options = std::make_shared<PlotOptions>();
  CLI::App* sub = app.add_subcommand("plot", "Draw trajectories on their map, or one scan");
  sub->add_option(
      "TRAJECTORY", options->trajectories,
      "TUM or KITTI poses, or what lilo run --poses or lilo record wrote, which tells status and "
      "sessions; the map is the first's");
  auto* truth = sub->add_option(
      "--truth", options->truth,
      "True poses, laid over the first trajectory's start; or the folder of a data set");
  sub->add_flag("--errors", options->errors, "Draw the errors over the distance instead")
      ->needs(truth);
  auto* input =
      sub->add_option("--input", options->input, "The recording the map or the scan comes from");
  sub->add_option("--config", options->config, "YAML configuration of the sensor");
  auto* scan = sub->add_option("--scan", options->scan, "Draw only this scan, the first being 0")
                   ->check(count());
  sub->add_flag("--features", options->features,
                "With --scan: the image's edges, surfaces and ground, as profile paper sees them")
      ->needs(scan);
  sub->add_option("--title", options->title, "Default: the recording's name");
  sub->add_option("--out", options->out, "The picture")->capture_default_str();
  scan->needs(input);
  sub->callback([options] {
    if (!options->scan && options->trajectories.empty()) {
      throw CLI::RequiredError("plot: TRAJECTORY or --scan");
    }
    run_plot(*options);
  });
}

}  // namespace lilo
