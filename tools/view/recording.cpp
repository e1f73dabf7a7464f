// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/recording.hpp"

#include "core/odometry.hpp"
#include "drivers/scan_source.hpp"
#include "tools/record/mcap_reader.hpp"
#include "tools/run/datagram_writer.hpp"
#include "tools/text_file.hpp"

#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <utility>

namespace lilo::view {
namespace {

// Most points a scan, more than lilod sends by default: no network lies between.
constexpr std::size_t kScanPoints = 1000, kMapPoints = 1000;
constexpr std::size_t kTellEvery = 20;  // scans

using Work = std::function<void(const std::atomic<bool>& stop)>;

Work play_scans(const std::string& path, const Config& config, const Recording::Take& take,
                const Recording::Tell& tell) {
  std::shared_ptr<ScanSource> source = open_scans(path, config.sensor);
  return [=](const std::atomic<bool>& stop) {
    Odometry odometry(config.odometry);
    DatagramWriter writer(config.publish);
    Scan scan;
    for (std::size_t k = 0; !stop && source->next(scan); ++k) {
      take(writer.pose(scan, odometry.process(scan)));
      writer.points(odometry, kScanPoints, kMapPoints, take);
      if (k % kTellEvery == 0) tell({.progress = source->progress(), .done = false, .error = {}});
    }
    tell({.progress = 1.0, .done = true, .error = source->error()});
  };
}

Work play_lines(const std::string& path, const Recording::Take& take, const Recording::Tell& tell) {
  auto file = std::make_shared<std::ifstream>(open_text(path));
  const auto size = static_cast<double>(std::filesystem::file_size(path));
  return [=](const std::atomic<bool>& stop) {
    double read = 0.0;
    std::size_t lines = 0;
    for (std::string line; !stop && std::getline(*file, line); ++lines) {
      read += static_cast<double>(line.size() + 1);
      if (!line.empty()) take(line);
      if (lines % (kTellEvery * kTellEvery) == 0)
        tell({.progress = read / size, .done = false, .error = {}});
    }
    tell({.progress = 1.0, .done = true, .error = {}});
  };
}

Work play_mcap(const std::string& path, const Recording::Take& take, const Recording::Tell& tell) {
  auto reader = std::make_shared<mcap::Reader>(path);
  return [=](const std::atomic<bool>& stop) {
    mcap::Message message;
    bool has_any = false;
    for (std::size_t k = 0; !stop && reader->next(message); ++k) {
      if (message.topic.starts_with("/lilod/")) {
        has_any = true;
        take(message.data);
      }
      if (k % (kTellEvery * kTellEvery) == 0)
        tell({.progress = reader->progress(), .done = false, .error = {}});
    }
    const char* error = has_any || stop ? "" : "no topic /lilod/..., so not of lilo record";
    tell({.progress = 1.0, .done = true, .error = error});
  };
}

Work work_for(const std::string& path, const Config& config, const Recording::Take& take,
              const Recording::Tell& tell) {
  const std::filesystem::path ending = std::filesystem::path(path).extension();
  if (ending == ".jsonl") return play_lines(path, take, tell);
  if (ending == ".mcap") return play_mcap(path, take, tell);
  return play_scans(path, config, take, tell);
}

}  // namespace

Recording::Recording(const std::string& path, const Config& config, const Take& take, Tell tell) {
  Work work = work_for(path, config, take, tell);
  thread_ = std::thread([this, work = std::move(work), tell = std::move(tell)] {
    try {
      work(stop_);
    } catch (const std::exception& error) {
      tell({.progress = 1.0, .done = true, .error = error.what()});
    }
  });
}

Recording::~Recording() {
  stop_ = true;
  thread_.join();
}

}  // namespace lilo::view
