// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/laser.hpp"
#include "tools/sim/motion.hpp"
#include "tools/sim/packet.hpp"
#include "tools/sim/rotor.hpp"

#include <cmath>

namespace lilo::sim {

/// Past-the-hour clock of the sensor, set by GPS (UTC) or started by its own power-up.
class SensorClock {
 public:
  /// `late_wrap_s`: how long after the hour the clock counts on beyond 3600 s before it starts
  /// again, as real units do at times.
  explicit SensorClock(std::int64_t utc_of_start_ns, double late_wrap_s = 0.0)
      : origin_ns_(utc_of_start_ns), late_ns_(static_cast<std::int64_t>(late_wrap_s * 1e9)) {}

  /// Counts from zero from here on: power-up without GPS.
  void restart(std::int64_t time_ns) { origin_ns_ = -time_ns; }
  /// Whole microseconds past the hour `time_ns` after the recording's start.
  [[nodiscard]] std::uint32_t stamp_us(std::int64_t time_ns) const {
    constexpr std::int64_t kHour_ns = 3'600'000'000'000;
    std::int64_t past = (origin_ns_ + time_ns) % kHour_ns;
    if (past < late_ns_ && time_ns > past) past += kHour_ns;  // the hour ended in this recording
    return static_cast<std::uint32_t>(past / 1000);
  }

 private:
  std::int64_t origin_ns_;
  std::int64_t late_ns_;
};

/// What an encoder works with. All must outlive it.
struct Rig {
  const SensorOptions& options;
  const SensorPath& path;
  const Rotor& rotor;
  const SensorClock& clock;
  Laser& laser;

  /// Fires a beam given in the sensor frame.
  [[nodiscard]] Shot fire(const Vec3& origin, const Vec3& direction, double time_s) const {
    const Placement pose = path.at(time_s);
    return laser.fire(pose * origin, pose.rotation * direction, time_s);
  }
  [[nodiscard]] bool is_blind(double azimuth_deg) const {
    const double width = options.blind_to_deg - options.blind_from_deg;
    const double into = azimuth_deg - options.blind_from_deg;
    return width > 0.0 && into - 360.0 * std::floor(into / 360.0) < width;
  }
};

/// Distance in the steps of the sensor; 0 = no return.
inline std::uint32_t distance_steps(double distance_m, double step_m = 0.002) {
  if (distance_m <= 0.0) return 0;
  const double steps = std::floor(distance_m / step_m + 0.5);
  return steps > 65535.0 ? 0 : static_cast<std::uint32_t>(steps);
}

/// Makes the sensor's data packets, one after the other.
class Encoder {
 public:
  Encoder() = default;
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  virtual ~Encoder() = default;

  /// The packet whose first firing is `start_ns` after the recording's start.
  virtual Packet encode(std::int64_t start_ns) = 0;
  /// From the first firing of a packet to that of the next.
  [[nodiscard]] virtual std::int64_t period_ns() const = 0;
  /// The sensor was switched off and on.
  virtual void power_up() {}
};

}  // namespace lilo::sim
