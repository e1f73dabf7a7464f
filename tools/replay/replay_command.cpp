// SPDX-License-Identifier: BSD-3-Clause
#include "tools/replay/replay_command.hpp"

#include "tools/cli.hpp"
#include "tools/replay/player.hpp"
#include "tools/stop_signals.hpp"
#include "tools/terminal/progress_bar.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <stdexcept>

namespace lilo {
namespace {

struct Command {
  std::string file;
  ReplayOptions replay;
  bool loop = false;
};

std::string summary(const ReplayCounts& counts) {
  const double seconds = static_cast<double>(counts.elapsed_ns) * 1e-9;
  const double per_second = seconds > 0.0 ? 1.0 / seconds : 0.0;
  return fmt::format(
      "{} packets in {:.1f} s: {:.0f} packets/s, {:.2f} Mbit/s, at most {:.1f} ms late",
      counts.packets, seconds, static_cast<double>(counts.packets) * per_second,
      static_cast<double>(counts.bytes) * 8e-6 * per_second,
      static_cast<double>(counts.latest_ns) * 1e-6);
}

void run_replay(const Command& command) {
  StopSignals stop;
  std::optional<ProgressBar> bar(std::in_place);
  std::unique_ptr<PacketSource> source = open_pcap(command.file);
  Player player(command.replay);
  const auto go_on = [&](const ReplayCounts& counts) {
    if (bar->due()) bar->show({command.loop ? 0.0 : source->progress(), counts.packets, "packets"});
    return !stop.raised();
  };
  while (player.play(*source, go_on) && command.loop && player.counts().packets > 0) {
    source = open_pcap(command.file);
  }
  bar.reset();
  fmt::print("{}\n", summary(player.counts()));
  if (!source->error().empty()) throw std::runtime_error(source->error());
}

}  // namespace

void add_replay_command(CLI::App& app) {
  auto command = std::make_shared<Command>();
  ReplayOptions& replay = command->replay;
  CLI::App* sub = app.add_subcommand("replay", "Play a capture as UDP packets at sensor speed");
  sub->add_option("FILE", command->file, "pcap; - is standard input")->required();
  sub->add_option("--to", replay.host, "Where the packets go")->capture_default_str();
  sub->add_option("--speed", replay.speed, "2 plays twice as fast")
      ->capture_default_str()
      ->check(above_zero());
  sub->add_flag("--loop", command->loop, "Begin again at the end, until Ctrl-C");
  sub->add_option("--data-port", replay.data_port,
                  "Port of the data packets; default: as in the capture");
  sub->add_option("--position-port", replay.position_port,
                  "Port of the position packets; default: as in the capture");
  sub->callback([command] { run_replay(*command); });
}

}  // namespace lilo
