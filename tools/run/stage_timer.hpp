// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/odometry.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace lilo {

/// Worker CPU time of every stage of every scan, in ms. The time from one call to the next belongs
/// to the stage that has just ended; a stage that reports twice in a scan gets the sum.
class StageTimer {
 public:
  /// The first scan is about to be read.
  void start();
  /// The scan has been read and decoded.
  void decoded();
  /// Times what Odometry::process() does.
  [[nodiscard]] StageHook hook();
  /// The pose is there. The next scan is about to be read.
  void finish();

  [[nodiscard]] const std::vector<double>& total_ms() const { return total_ms_; }
  [[nodiscard]] const std::vector<double>& decode_ms() const { return decode_ms_; }
  [[nodiscard]] const std::vector<double>& stage_ms(Stage stage) const {
    return stage_ms_[static_cast<std::size_t>(stage)];
  }

 private:
  double lap_ms();

  std::int64_t scan_start_ns_ = 0, lap_start_ns_ = 0;
  double decode_now_ms_ = 0.0;
  std::array<double, kStageCount> stage_now_ms_{};
  std::vector<double> total_ms_, decode_ms_;
  std::array<std::vector<double>, kStageCount> stage_ms_;
};

}  // namespace lilo
