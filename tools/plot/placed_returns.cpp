// SPDX-License-Identifier: BSD-3-Clause
#include "tools/plot/placed_returns.hpp"

namespace lilo {

void ReturnPlacer::next(const Scan& scan, const Pose& T_odom_sensor) {
  constexpr int kTimeSlots = 64;  // poses within a scan: 1.6 ms apart, 3 cm at 20 m/s
  const std::int64_t since_ns = any_ ? previous_ns_ : scan.start_ns;
  const Pose& from = any_ ? previous_ : T_odom_sensor;
  const auto span_ns = static_cast<double>(scan.end_ns - since_ns);
  const auto scan_ns = static_cast<double>(scan.end_ns - scan.start_ns);
  const bool still = scan.motion_compensated || span_ns <= 0.0;
  poses_.clear();
  for (int k = 0; k <= kTimeSlots; ++k) {
    const double before_end_ns = scan_ns * (kTimeSlots - k) / kTimeSlots;
    poses_.push_back(still ? T_odom_sensor
                           : interpolate(from, T_odom_sensor, 1.0 - before_end_ns / span_ns));
  }
  slot_ns_ = scan_ns / kTimeSlots + 1.0;
  any_ = true;
  previous_ = T_odom_sensor;
  previous_ns_ = scan.end_ns;
}

}  // namespace lilo
