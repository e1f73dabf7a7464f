// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/sim_command.hpp"

#include "tools/sim/sim_options.hpp"
#include "tools/sim/simulate.hpp"
#include "tools/sim/world.hpp"
#include "tools/terminal/progress_bar.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

namespace lilo {
namespace {

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

sim::SimSummary simulate(const sim::SimArguments& arguments) {
  if (arguments.quiet) return sim::simulate(arguments.options, arguments.folder, [](double) {});
  ProgressBar bar;
  return sim::simulate(arguments.options, arguments.folder, [&](double part) {
    if (bar.due()) bar.show({part, 0, arguments.folder});
  });
}

void run_sim(const CLI::App& command, sim::SimArguments& arguments) {
  sim::settle(command, arguments);
  sim::check_folder(arguments);
  const sim::SimSummary summary = simulate(arguments);
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
