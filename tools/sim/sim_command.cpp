#include "tools/sim/sim_command.hpp"

#include "tools/sim/sim_options.hpp"
#include "tools/sim/simulate.hpp"
#include "tools/sim/world.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>
#include <unistd.h>

namespace lilo {
namespace {

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

std::string footer() {
  std::string text = "\nWorlds (default speed):\n";
  for (const sim::WorldInfo& world : sim::known_worlds()) {
    text += fmt::format("  {:<9} {} ({} m/s)\n", world.name, world.about, world.default_speed_mps);
  }
  return text +
         "\nThe folder receives data.pcap; gt_start.tum and gt_end.tum, the sensor's pose at the "
         "start\n"
         "and end of every complete revolution; gt_end_kitti.txt; gt_dense.tum, every 5 ms; "
         "revs.csv;\n"
         "calibration.yaml (HDL-64E also db.xml); frame.txt; meta.json. Poses are in the sensor "
         "frame\n"
         "at the start of revolution 0, times are UTC. Same options, same bytes.\n";
}

void run_sim(const CLI::App& command, sim::SimArguments& arguments) {
  sim::settle(command, arguments);
  sim::check_folder(arguments);
  ProgressBar bar(!arguments.quiet);
  const sim::SimSummary summary =
      sim::simulate(arguments.options, arguments.folder, [&](double done) { bar(done); });
  fmt::print("{}: {} revolutions, {} data packets, {:.1f} m driven\n", arguments.folder,
             summary.revolutions, summary.packets_sent, summary.path_length_m);
  const sim::FaultCounts& faults = summary.faults;
  if (faults.lost + faults.duplicates + faults.reordered + faults.garbage > 0) {
    fmt::print("{} packets lost, {} duplicated, {} reordered, {} foreign\n", faults.lost,
               faults.duplicates, faults.reordered, faults.garbage);
  }
}

}  // namespace

void add_sim_command(CLI::App& app) {
  auto arguments = std::make_shared<sim::SimArguments>();
  CLI::App* command =
      app.add_subcommand("sim", "Make a capture of a simulated drive, with exact truth");
  command->footer(footer());
  sim::add_options(*command, *arguments);
  command->callback([arguments, command] { run_sim(*command, *arguments); });
}

}  // namespace lilo
