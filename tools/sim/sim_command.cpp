#include "tools/sim/sim_command.hpp"

#include "tools/cli.hpp"
#include "tools/sim/simulate.hpp"
#include "tools/sim/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <unistd.h>
#include <vector>

namespace lilo {
namespace {

using sim::SimOptions;

struct SimCommand {
  SimOptions options;
  std::string folder;
  std::string start_utc;
  double blind_width_deg = 0.0;
  bool quiet = false;
};

/// A bar on a terminal, nothing elsewhere.
class ProgressBar {
 public:
  explicit ProgressBar(bool wanted) : shown_(wanted && isatty(STDERR_FILENO) == 1) {}

  void operator()(double done) {
    const int percent = static_cast<int>(100.0 * done);
    if (!shown_ || percent == last_) return;
    last_ = percent;
    constexpr int kWidth = 40;
    const int filled = kWidth * percent / 100;
    fmt::print(stderr, "\r[{:=<{}}{: <{}}] {:3} %{}", "", filled, "", kWidth - filled, percent,
               percent == 100 ? "\n" : "");
    std::fflush(stderr);
  }

 private:
  bool shown_;
  int last_ = -1;
};

std::string world_list() {
  std::string text = "\nWorlds:\n";
  for (const sim::WorldInfo& world : sim::known_worlds()) {
    text += fmt::format("  {:<10} {} ({} m/s)\n", world.name, world.about, world.default_speed_mps);
  }
  text +=
      "\nThe folder receives data.pcap, gt_start.tum and gt_end.tum (sensor pose at the start and "
      "end\n"
      "of every complete revolution), gt_end_kitti.txt, gt_dense.tum (every 5 ms), revs.csv,\n"
      "calibration.yaml, frame.txt and meta.json. Poses are in the sensor frame at the start of\n"
      "revolution 0. Same options, same bytes.\n";
  return text;
}

void add_motion_options(CLI::App& command, SimOptions& options) {
  sim::MotionOptions& motion = options.motion;
  command.add_option("--duration-s", motion.duration_s, "Length of the recording")
      ->capture_default_str()
      ->check(CLI::Range(0.2, 7200.0));
  command
      .add_option("--speed-mps", motion.speed_mps,
                  "Speed wished for; slower in curves (default: the world's)")
      ->check(CLI::Range(0.0, 60.0));
  command.add_flag("--start-in-motion", motion.start_in_motion,
                   "At speed from the first packet on");
  command.add_option("--standstill-s", motion.standstill_s, "Standing before setting off")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 7200.0));
  command
      .add_option("--turn-rate-dps", motion.turn_rate_dps,
                  "Turns this fast on top of the route's heading; with --speed-mps 0 on the spot")
      ->check(CLI::Range(-400.0, 400.0));
  command.add_option("--tilt-deg", motion.tilt_deg, "Sensor mounted nose down by this angle")
      ->check(CLI::Range(-45.0, 45.0));
  command
      .add_option("--sensor-height-m", options.sensor_height_m,
                  "Above the ground (default: the world's)")
      ->check(CLI::Range(0.2, 5.0));
}

void add_sensor_options(CLI::App& command, SimOptions& options) {
  sim::SensorOptions& sensor = options.sensor;
  command.add_option("--sensor", sensor.sensor, "vlp16 or vlp16-hires")
      ->transform(CLI::CheckedTransformer(std::map<std::string, sim::Sensor>{
          {"vlp16", sim::Sensor::vlp16}, {"vlp16-hires", sim::Sensor::vlp16_hires}}));
  command.add_option("--returns", sensor.returns, "strongest, last or dual")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, sim::ReturnMode>{{"strongest", sim::ReturnMode::strongest},
                                                 {"last", sim::ReturnMode::last},
                                                 {"dual", sim::ReturnMode::dual}}));
  command.add_option("--rpm", sensor.rpm, "Turns per minute")
      ->capture_default_str()
      ->check(CLI::Range(300.0, 1200.0));
  command
      .add_option("--range-sigma-m", sensor.range_sigma_m,
                  "Range noise (default 0.012, HDL-64E 0.018)")
      ->check(CLI::Range(0.0, 1.0));
  command
      .add_option(
          "--dropout", sensor.dropout,
          "Part of good echoes that is lost; faint ones are lost more; 0: every echo is seen")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  command.add_option("--max-range-m", sensor.max_range_m, "No echo beyond")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 130.0));
}

void run_sim(SimCommand& command, bool speed_given) {
  SimOptions& options = command.options;
  for (const sim::WorldInfo& world : sim::known_worlds()) {
    if (world.name == options.world && !speed_given) {
      options.motion.speed_mps = world.default_speed_mps;
    }
  }
  ProgressBar bar(!command.quiet);
  const sim::SimSummary summary =
      sim::simulate(options, command.folder, [&](double done) { bar(done); });
  fmt::print("{}: {} revolutions, {} data packets, {} position packets, {:.1f} m driven\n",
             command.folder, summary.revolutions, summary.packets_sent, summary.position_packets,
             summary.path_length_m);
}

}  // namespace

void add_sim_command(CLI::App& app) {
  auto state = std::make_shared<SimCommand>();
  CLI::App* command =
      app.add_subcommand("sim", "Make a capture of a simulated drive, with exact truth");
  command->footer(world_list());
  command->add_option("OUT_DIR", state->folder, "Folder to write to; made if missing")->required();
  std::vector<std::string> names;
  for (const sim::WorldInfo& world : sim::known_worlds()) names.push_back(world.name);
  command->add_option("--world", state->options.world, "Where to drive")
      ->capture_default_str()
      ->check(CLI::IsMember(names));
  command
      ->add_option("--seed", state->options.seed, "Another number, another world and other noise")
      ->capture_default_str();
  add_motion_options(*command, state->options);
  add_sensor_options(*command, state->options);
  command->add_flag("--quiet", state->quiet, "No progress bar");
  command->callback([state, command] { run_sim(*state, command->count("--speed-mps") > 0); });
}

}  // namespace lilo
