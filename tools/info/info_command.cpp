// SPDX-License-Identifier: BSD-3-Clause
#include "tools/info/info_command.hpp"

#include "drivers/beam_file.hpp"
#include "tools/info/beams_text.hpp"
#include "tools/info/info_report.hpp"
#include "tools/terminal/progress_bar.hpp"
#include "tools/tool_config.hpp"

#include <fmt/format.h>

#include <memory>
#include <stdexcept>

namespace lilo {
namespace {

struct InfoOptions {
  std::string input, config;
  bool json = false;
};

RecordingInfo read_with_progress(ScanSource& source) {
  ProgressBar bar;
  std::size_t scans = 0;
  return read_recording(source, [&](const Scan&) {
    ++scans;
    if (bar.due()) bar.show({source.progress(), scans, "scans"});
  });
}

void run_info(const InfoOptions& options) {
  if (is_beams_file(options.input)) {
    const BeamEstimate beams = read_beams(options.input);
    fmt::print("{}", options.json ? to_json(beams) : to_text(beams));
    return;
  }
  const Config config = tool_config(options.config);
  const std::unique_ptr<ScanSource> source = open_scans(options.input, config.sensor);
  const RecordingInfo info = read_with_progress(*source);
  fmt::print("{}", options.json ? to_json(options.input, info) : to_text(options.input, info));
  if (!info.failure.empty()) throw std::runtime_error(info.failure);
  if (info.driver_counts.data_packets == 0 && info.scans == 0) {
    throw std::runtime_error(
        fmt::format("{}: expected packets of a rotating Velodyne, found none", options.input));
  }
}

}  // namespace

void add_info_command(CLI::App& app) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* sub =
      app.add_subcommand("info", "Tell what a recording holds, or the beams.yaml of lilod");
  sub->add_option(
         "INPUT", options->input,
         "pcap (- is standard input), folder of KITTI scans, KITTI sequence, or beams.yaml")
      ->required();
  sub->add_option("--config", options->config, "YAML configuration; default: what is built in");
  sub->add_flag("--json", options->json, "For programs; lists every scan that misses packets");
  sub->callback([options] { run_info(*options); });
}

}  // namespace lilo
