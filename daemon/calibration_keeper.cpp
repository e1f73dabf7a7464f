// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/calibration_keeper.hpp"

#include "daemon/log.hpp"

#include <fmt/format.h>

#include <utility>

namespace lilo {

CalibrationKeeper::CalibrationKeeper(boost::asio::io_context& io, const Receiver& receiver,
                                     std::string directory)
    : receiver_(receiver), directory_(std::move(directory)), saver_(io) {}

void CalibrationKeeper::look() {
  const std::uint64_t read = receiver_.calibrations_read();
  if (directory_.empty() || read == kept_ || saver_.busy()) return;
  CalibrationTable table;
  if (!receiver_.calibration().load(table)) return;  // overtaken: in a second
  const Calibration calibration = table.calibration();
  kept_ = read;
  saver_.write(
      stored_calibration_path(directory_), calibration.lasers.size(),
      [calibration] { return calibration_yaml(calibration); },
      [](const SaveResult& result) {
        if (result.error.empty()) {
          log_event(Event::calibration_stored, fmt::format("calibration stored: {}", result.file));
        } else {
          log_event(Event::calibration_not_stored,
                    fmt::format("calibration not stored: {}", result.error));
        }
      });
}

}  // namespace lilo
