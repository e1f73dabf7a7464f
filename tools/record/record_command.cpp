#include "tools/record/record_command.hpp"

#include "tools/cli.hpp"
#include "tools/clock.hpp"
#include "tools/connection/address_options.hpp"
#include "tools/record/recording.hpp"
#include "tools/stop_signals.hpp"
#include "tools/terminal/progress_bar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>

namespace lilo {
namespace {

struct RecordOptions {
  LilodAddress address;
  std::string file;
  std::uint64_t count = 0;  // 0: no end
  double duration_s = 0.0;  // 0: no end
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

/// Until Ctrl-C, or as many as were asked for.
void record(Connection& lilod, const RecordOptions& options, StopSignals& stop, Recording& out) {
  constexpr std::chrono::milliseconds kLook{200};
  const std::int64_t start_ns = monotonic_ns();
  ProgressBar bar;
  lilod.subscribe();
  for (double part = 0.0; part < 1.0 && !stop.raised();) {
    if (const auto datagram = lilod.receive(kLook, stop.descriptor()))
      out.take(*datagram, clock_ns(CLOCK_REALTIME));
    const std::uint64_t poses = out.counts().poses;
    part = part_done(options, poses, static_cast<double>(monotonic_ns() - start_ns) * 1e-9);
    if (bar.due()) bar.show({part, poses, "poses"});
  }
}

void run_record(const RecordOptions& options) {
  check_file(options.file, options);
  StopSignals stop;
  Connection lilod(options.address);
  Recording out(options.file);
  record(lilod, options, stop, out);
  out.finish();
  if (out.counts().poses == 0) {
    throw std::runtime_error(fmt::format("{}: no pose came from {}: lilo status says why",
                                         options.file, to_string(options.address)));
  }
  fmt::print("{}: {}\n", options.file, to_text(out.counts()));
}

}  // namespace

void add_record_command(CLI::App& app) {
  auto options = std::make_shared<RecordOptions>();
  CLI::App* sub = app.add_subcommand("record", "Write what a running lilod sends to a file");
  sub->add_option("FILE", options->file,
                  "The ending says how: .jsonl (datagrams), .mcap (Foxglove) or .tum (poses, a "
                  "file a session)")
      ->required();
  add_address_options(*sub, options->address);
  sub->add_option("--count", options->count, "End after so many poses; default: with Ctrl-C")
      ->check(above_zero());
  sub->add_option("--duration-s", options->duration_s, "End after so many seconds")
      ->check(above_zero());
  sub->add_flag("--force", options->force, "Replace what is there");
  sub->callback([options] { run_record(*options); });
}

}  // namespace lilo
