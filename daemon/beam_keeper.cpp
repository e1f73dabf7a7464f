// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/beam_keeper.hpp"

#include "daemon/log.hpp"
#include "daemon/metrics_file.hpp"
#include "drivers/beam_file.hpp"
#include "drivers/packet_source.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <utility>

namespace lilo {
namespace {

constexpr int kEverySeconds = 60;

}  // namespace

BeamEstimate kept_beams(const std::string& directory) {
  const std::string path = kept_beams_path(directory);
  std::error_code error;
  if (directory.empty() || !std::filesystem::exists(path, error)) return {};
  try {
    const BeamEstimate beams = read_beams(path);
    log_event(Event::beams_resumed,
              fmt::format("errors of the beams as found earlier, of {} rings: {}", beams.ring_count,
                          path));
    return beams;
  } catch (const DriverError& refusal) {
    log_event(Event::beams_file_failed,
              fmt::format("errors of the beams not read: {}", refusal.what()));
    return {};
  }
}

BeamKeeper::BeamKeeper(boost::asio::io_context& io, const Snapshot<BeamEstimate>& beams,
                       std::string directory)
    : beams_(beams), directory_(std::move(directory)), saver_(io) {}

bool BeamKeeper::is_new() {
  if (directory_.empty() || !beams_.load(now_)) return false;
  const bool is_known = largest_elevation_rad(now_) > 0.0 || largest_azimuth_rad(now_) > 0.0;
  return is_known && !(now_ == kept_);
}

void BeamKeeper::note(const std::string& error) {
  if (!error.empty() && error != last_error_)
    log_event(Event::beams_file_failed, fmt::format("errors of the beams not kept: {}", error));
  last_error_ = error;
}

void BeamKeeper::look() {
  if (++seconds_ < kEverySeconds || saver_.busy()) return;
  seconds_ = 0;
  if (!is_new()) return;
  kept_ = now_;
  saver_.write(
      kept_beams_path(directory_), static_cast<std::size_t>(now_.ring_count),
      [beams = now_] { return beams_yaml(beams); },
      [this](const SaveResult& result) {
        if (!result.error.empty()) kept_ = {};
        note(result.error);
      });
}

void BeamKeeper::finish() {
  if (saver_.busy() || !is_new()) return;
  const std::string path = kept_beams_path(directory_);
  const std::error_code error = replace_file(path, beams_yaml(now_));
  note(error ? path + ": " + error.message() : "");
}

}  // namespace lilo
