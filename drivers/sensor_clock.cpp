// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/sensor_clock.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace lilo {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kHourNs = 3600 * kSecondNs;
constexpr std::int64_t kSynchronizedNs = kSecondNs / 2;
constexpr std::int64_t kGpsLifetimeNs = 60 * kSecondNs;
constexpr std::int64_t kSilenceNs = 60 * kSecondNs;  // from here the computer's clock counts hours
constexpr std::int64_t kContinuedNs = 100'000'000;   // no silence at all
constexpr std::int64_t kDeadBandNs = 2'000'000;
constexpr std::int64_t kSlewNs = 10'000;           // a scan: 1e-4 at 600 rpm
constexpr std::int64_t kAstrayNs = kSecondNs / 2;  // the computer's clock was set
constexpr int kAstrayScans = 10;

// The instant with these minutes and seconds that is nearest to `reference_ns`.
std::int64_t nearest_hour(std::int64_t past_hour_ns, std::int64_t reference_ns) {
  const auto hours = std::llround(static_cast<double>(reference_ns - past_hour_ns) / kHourNs);
  return hours * kHourNs + past_hour_ns;
}

}  // namespace

std::int64_t SensorClock::unwrap(std::uint32_t stamp_us, std::int64_t received_ns) {
  const std::int64_t past_hour_ns = std::int64_t{stamp_us} * 1000;
  std::int64_t line_ns = nearest_hour(past_hour_ns, started_ ? last_line_ns_ : received_ns);
  const std::int64_t silence_ns = received_ns - last_received_ns_;
  // A stamp that just continues means that the computer's clock was set, by whole hours perhaps: a
  // silence would have to end within this of a whole hour.
  if (started_ && silence_ns > kSilenceNs && std::abs(line_ns - last_line_ns_) > kContinuedNs)
    line_ns = nearest_hour(past_hour_ns, last_line_ns_ + silence_ns);
  started_ = true;
  last_line_ns_ = line_ns;
  last_received_ns_ = received_ns;
  const std::int64_t delay_ns = received_ns - line_ns;
  least_delay_ns_ = has_delay_ ? std::min(least_delay_ns_, delay_ns) : delay_ns;
  has_delay_ = true;
  return line_ns;
}

void SensorClock::gps_fix(std::uint32_t stamp_us, std::int64_t gps_utc_ns,
                          std::int64_t received_ns) {
  const std::int64_t past_hour_ns = std::int64_t{stamp_us} * 1000;
  const std::int64_t utc_ns = nearest_hour(past_hour_ns, gps_utc_ns);
  // The sentence names the second before the pulse or the one after; more is no synchronised clock.
  if (std::abs(utc_ns - gps_utc_ns) > 2 * kSecondNs) return;
  const std::int64_t line_ns = nearest_hour(past_hour_ns, started_ ? last_line_ns_ : received_ns);
  gps_shift_ns_ = utc_ns - line_ns;
  gps_line_ns_ = line_ns;
  gps_heard_ = true;
}

bool SensorClock::gps_is_fresh(std::int64_t line_ns) const {
  return gps_heard_ && std::abs(line_ns - gps_line_ns_) < kGpsLifetimeNs;
}

void SensorClock::begin_scan(std::int64_t line_ns) {
  use_gps_ = gps_is_fresh(line_ns);
  if (use_gps_) {
    shift_ns_ = gps_shift_ns_;
    placed_ = true;
    free_running_ = false;
  } else {
    follow_host();
  }
  has_delay_ = false;
}

void SensorClock::follow_host() {
  if (!has_delay_) return;
  const std::int64_t astray_ns = least_delay_ns_ - shift_ns_;
  const bool far = std::abs(astray_ns) > kAstrayNs;
  scans_astray_ = far ? scans_astray_ + 1 : 0;
  if (!placed_ || scans_astray_ >= kAstrayScans) {
    // A whole number of hours keeps the sensor's minutes; anything else is a clock of its own.
    const std::int64_t whole_hours_ns = nearest_hour(0, least_delay_ns_);
    free_running_ = std::abs(least_delay_ns_ - whole_hours_ns) > kSynchronizedNs;
    shift_ns_ = free_running_ ? least_delay_ns_ : whole_hours_ns;
    placed_ = true;
    scans_astray_ = 0;
  } else if (free_running_ && !far && std::abs(astray_ns) > kDeadBandNs) {
    shift_ns_ += astray_ns > 0 ? kSlewNs : -kSlewNs;
  }
}

void SensorClock::restart() { *this = SensorClock(); }

}  // namespace lilo
