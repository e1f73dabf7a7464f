// SPDX-License-Identifier: BSD-3-Clause
#include "tools/record/record_command.hpp"

#include "daemon/packet_message.hpp"
#include "tools/cli.hpp"
#include "tools/clock.hpp"
#include "tools/connection/address_options.hpp"
#include "tools/record/packet_recording.hpp"
#include "tools/record/recording.hpp"
#include "tools/stop_signals.hpp"
#include "tools/terminal/progress_bar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace lilo {
namespace {

struct RecordOptions {
  LilodAddress address;
  std::string file;
  std::string packets_file;  // empty: no packets
  std::uint64_t count = 0;   // 0: no end
  double duration_s = 0.0;   // 0: no end
  bool force = false;
};

/// In [0, 1]; 0 while the end is not known.
double part_done(const RecordOptions& options, std::uint64_t poses, double elapsed_s) {
  double part = 0.0;
  if (options.count > 0) part = static_cast<double>(poses) / static_cast<double>(options.count);
  if (options.duration_s > 0.0) part = std::max(part, elapsed_s / options.duration_s);
  return part;
}

void check_file(const std::string& file, const RecordOptions& options) {
  if (!options.force && std::filesystem::exists(file))
    throw std::runtime_error(fmt::format("{}: is there already (--force replaces it)", file));
}

void check_files(const RecordOptions& options) {
  check_file(options.file, options);
  if (options.packets_file.empty()) return;
  if (options.packets_file == options.file)
    throw std::runtime_error(fmt::format("{}: expected another file for packets", options.file));
  check_file(options.packets_file, options);
}

/// The files that are written.
struct Files {
  Recording messages;
  std::optional<PacketRecording> packets;

  void take(std::string_view datagram) {
    if (packets && is_packet(datagram)) {
      packets->take(datagram);
    } else {
      messages.take(datagram, clock_ns(CLOCK_REALTIME));
    }
  }
  void finish() {
    messages.finish();
    if (packets) packets->finish();
  }
};

/// Until Ctrl-C, or as many as were asked for.
void record(Connection& lilod, const RecordOptions& options, StopSignals& stop, Files& out) {
  constexpr std::chrono::milliseconds kLook{200};
  const std::int64_t start_ns = monotonic_ns();
  ProgressBar bar;
  for (double part = 0.0; part < 1.0 && !stop.raised();) {
    if (const auto datagram = lilod.receive(kLook, stop.descriptor())) out.take(*datagram);
    const std::uint64_t poses = out.messages.counts().poses;
    part = part_done(options, poses, static_cast<double>(monotonic_ns() - start_ns) * 1e-9);
    if (bar.due()) bar.show({part, poses, "poses"});
  }
}

void run_record(const RecordOptions& options) {
  check_files(options);
  StopSignals stop;
  Connection lilod(options.address);
  // Before there is a file: it may refuse.
  const bool with_packets = !options.packets_file.empty();
  lilod.subscribe(with_packets ? Subscription::with_packets : Subscription::messages);
  Files out{.messages = Recording(options.file), .packets = {}};
  if (with_packets) out.packets.emplace(options.packets_file);
  record(lilod, options, stop, out);
  out.finish();
  if (out.packets) fmt::print("{}: {}\n", options.packets_file, to_text(*out.packets));
  if (out.messages.counts().poses == 0) {
    throw std::runtime_error(fmt::format("{}: no pose came from {}: lilo status says why",
                                         options.file, to_string(options.address)));
  }
  fmt::print("{}: {}\n", options.file, to_text(out.messages.counts()));
}

}  // namespace

void add_record_command(CLI::App& app) {
  auto options = std::make_shared<RecordOptions>();
  CLI::App* sub = app.add_subcommand("record", "Write what a running lilod sends to a file");
  sub->add_option("FILE", options->file,
                  "The ending says how: .jsonl (datagrams), .mcap (Foxglove) or .tum (poses, a "
                  "file a session)")
      ->required();
  sub->add_option(
         "--packets", options->packets_file,
         "Write the sensor's packets beside it, as a pcap file that lilo run and Wireshark "
         "read; needs subscribe.packets_clients in the daemon's configuration, not root")
      ->type_name("FILE.pcap");
  add_address_options(*sub, options->address);
  sub->add_option("--count", options->count, "End after so many poses; default: with Ctrl-C")
      ->check(above_zero());
  sub->add_option("--duration-s", options->duration_s, "End after so many seconds")
      ->check(above_zero());
  sub->add_flag("--force", options->force, "Replace what is there");
  sub->callback([options] { run_record(*options); });
}

}  // namespace lilo
