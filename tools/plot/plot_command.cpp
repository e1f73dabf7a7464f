#include "tools/plot/plot_command.hpp"

#include "drivers/scan_source.hpp"
#include "tools/eval/associate.hpp"
#include "tools/plot/scan_view.hpp"
#include "tools/plot/trajectory_view.hpp"
#include "tools/progress_bar.hpp"
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
  std::string out = "plot.png";
  std::optional<std::uint64_t> scan;
};

std::string base_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
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
    if (bar.due()) bar.show(source.progress(), "building the map");
  }
  return map;
}

void plot_trajectories(const PlotOptions& options) {
  std::vector<Trajectory> estimates;
  for (const std::string& file : options.trajectories) {
    estimates.push_back(read_trajectory(file));
    estimates.back().name =
        estimates.size() == 1 && options.trajectories.size() == 1 ? "estimate" : base_name(file);
  }
  std::optional<Trajectory> truth;
  if (!options.truth.empty()) truth = read_trajectory(options.truth);
  MapPoints map;
  if (!options.input.empty()) map = build_map(*open_input(options), estimates.front());
  const std::string& subject = options.input.empty() ? options.trajectories[0] : options.input;
  const std::string title = options.title.empty() ? base_name(subject) : options.title;
  draw(trajectory_view(title, estimates, truth, map)).save(options.out);
}

std::string scan_title(const Scan& scan) {
  const std::time_t seconds = scan.start_ns / 1'000'000'000;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  return fmt::format("scan {}, {:%Y-%m-%d %H:%M:%S}.{:03d} UTC, {} returns", scan.index, utc,
                     scan.start_ns % 1'000'000'000 / 1'000'000, scan.returns.size());
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
  const std::string title = options.title.empty() ? base_name(options.input) : options.title;
  draw(scan, title + ", " + scan_title(scan)).save(options.out);
}

void run_plot(const PlotOptions& options) {
  if (options.scan) {
    plot_scan(options);
  } else {
    plot_trajectories(options);
  }
  fmt::print("{}\n", options.out);
}

}  // namespace

void add_plot_command(CLI::App& app) {
  auto options = std::make_shared<PlotOptions>();
  CLI::App* sub = app.add_subcommand("plot", "Draw trajectories on their map, or one scan");
  sub->add_option("TRAJECTORY", options->trajectories,
                  "TUM or KITTI poses; the map is the first's");
  sub->add_option("--truth", options->truth, "True poses, laid over the first trajectory's start");
  auto* input =
      sub->add_option("--input", options->input, "The recording the map or the scan comes from");
  sub->add_option("--config", options->config, "YAML configuration of the sensor");
  auto* scan = sub->add_option("--scan", options->scan, "Draw only this scan, the first being 0");
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
