// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/calibration.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace lilo {

/// A calibration that packets brought, HDL-64E alone, as threads share it: without memory of its
/// own.
struct CalibrationTable {
  static constexpr std::size_t kLasers = 64;

  std::array<LaserCorrection, kLasers> lasers{};
  double distance_step_m = 0.0;

  CalibrationTable() = default;
  explicit CalibrationTable(const Calibration& calibration)
      : distance_step_m(calibration.distance_step_m) {
    std::copy_n(calibration.lasers.begin(), std::min(calibration.lasers.size(), kLasers),
                lasers.begin());
  }

  [[nodiscard]] Calibration calibration() const {
    return {{lasers.begin(), lasers.end()}, distance_step_m};
  }

  bool operator==(const CalibrationTable&) const = default;
};

}  // namespace lilo
