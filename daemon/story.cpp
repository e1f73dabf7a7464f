// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/story.hpp"

#include "daemon/clock.hpp"
#include "daemon/complaints.hpp"
#include "daemon/log.hpp"
#include "daemon/pose_message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

namespace lilo {
namespace {

constexpr int kCalmForS = 3;
constexpr std::int64_t kFaultsEveryNs = 10'000'000'000;
constexpr double kRpmChange = 30.0;  // Velodyne's speeds are set in steps of 60

double seconds_since(std::int64_t then_ns) {
  return static_cast<double>(monotonic_ns() - then_ns) * 1e-9;
}

std::string dotted(std::uint32_t ipv4) {
  return fmt::format("{}.{}.{}.{}", ipv4 >> 24U, ipv4 >> 16U & 0xffU, ipv4 >> 8U & 0xffU,
                     ipv4 & 0xffU);
}

bool differ(const SensorStatus& a, const SensorStatus& b) {
  return a.model != b.model || a.product_id != b.product_id || a.sensor_ipv4 != b.sensor_ipv4 ||
         a.return_mode != b.return_mode || a.clock != b.clock ||
         std::abs(a.rpm - b.rpm) > kRpmChange;
}

}  // namespace

void Story::note(const PoseReport& report) {
  const Estimate& e = report.estimate;
  ++poses_.all;
  if (e.status == TrackingStatus::initializing) ++poses_.initializing;
  if (e.status == TrackingStatus::degraded) ++poses_.degraded;
  if (e.status == TrackingStatus::lost) ++poses_.lost;
  if (!report.scan_complete) ++poses_.partial;
  if (e.is_motion_doubtful) ++poses_.doubtful;
  if (e.is_uncertain && e.status == TrackingStatus::degraded) ++poses_.uncertain;
  if (!e.is_confirmed && e.status == TrackingStatus::degraded) ++poses_.unconfirmed;
  if (e.weak_count > 0 && e.weak_directions[0].from_scan < poses_.weakest_from_scan) {
    poses_.weakest_from_scan = e.weak_directions[0].from_scan;
    e.weak_directions[0].direction.cwiseAbs().maxCoeff(&poses_.weakest_axis);
  }
  note_relocalization(report);
}

// How far the place found lies from where motion at the last speed would have led.
void Story::note_relocalization(const PoseReport& report) {
  const Estimate& e = report.estimate;
  const bool same_origin = report.resets == resets_ && e.restarts == restarts_;
  resets_ = report.resets;
  restarts_ = e.restarts;
  if (!same_origin) lost_poses_ = 0;
  if (e.status == TrackingStatus::lost) {
    ++lost_poses_;
  } else if (lost_poses_ > 0) {
    const Pose predicted = last_ * (before_last_.inverse() * last_);
    const Pose jump = predicted.inverse() * e.T_odom_sensor;
    found_ = {.lost_poses = lost_poses_,
              .distance_m = jump.translation_m.norm(),
              .angle_rad = Eigen::AngleAxisd(jump.rotation).angle()};
    lost_poses_ = 0;
  }
  before_last_ = same_origin ? last_ : e.T_odom_sensor;
  last_ = e.T_odom_sensor;
}

void Story::session_replaced(const std::string& before, const std::string& now, bool by_reset) {
  if (by_reset) {
    log_event(Event::session_reset,
              fmt::format("session {}: begun by a reset, in place of {}", now, before));
  } else {
    log_event(Event::session_replaced,
              fmt::format("session {}: in place of {}, whose map was given up; it begins where "
                          "the prediction ended",
                          now, before));
  }
  tracking_ = TrackingStatus::initializing;
  poses_ = {};
  found_ = {};
  calm_s_ = 0;
}

void Story::second(const Health& h) {
  tell_sensor(h);
  tell_tilt(h);
  tell_wrong_sensor(h);
  tell_second_sensor(h);
  tell_calibration(h.sensor);
  tell_flow(h);
  if (poses_.all > 0) tell_tracking();
  tell_clients(h);
  tell_clock(h);
  tell_faults(h);
  poses_ = {};
}

void Story::tell_sensor(const Health& h) {
  const SensorStatus& now = h.sensor;
  if (now.model == SensorModel::automatic || now.rpm <= 0.0 || !differ(now, sensor_)) return;
  const bool told = log_event(Event::sensor_found,
                              fmt::format("sensor: {} at {}, {:.0f} rpm, returns {}, clock {}",
                                          to_string(now.model), dotted(now.sensor_ipv4), now.rpm,
                                          to_string(now.return_mode), to_string(now.clock)));
  if (told) sensor_ = now;
}

// Once: a reset keeps the axes.
void Story::tell_tilt(const Health& h) {
  if (h.tilt_deg == tilt_deg_) return;
  if (log_event(Event::sensor_levelled,
                fmt::format("sensor: {}, its z axis is {:.1f} deg off the normal of the ground in "
                            "its first scan; scans are levelled",
                            h.tilt_deg > 90.0 ? "upside down" : "tilted", h.tilt_deg))) {
    tilt_deg_ = h.tilt_deg;
  }
}

// Once while they come, and again when they are of yet another model.
void Story::tell_wrong_sensor(const Health& h) {
  const RefusedSensor& now = h.sensor.refused;
  if (h.recent[Fault::wrong_sensor_packets] == 0) {
    wrong_sensor_ = {};
    return;
  }
  const bool same = now.model == wrong_sensor_.model && now.product_id == wrong_sensor_.product_id;
  if (wrong_sensor_.packets > 0 && same) return;
  WordsBuffer buffer;
  if (log_event(Event::sensor_refused, words(Complaint::wrong_sensor, h, buffer)))
    wrong_sensor_ = now;
}

void Story::tell_second_sensor(const Health& h) {
  const bool now = h.recent[Fault::foreign_packets] > 0;
  if (now == second_sensor_) return;
  if (now && !log_event(Event::second_sensor,
                        fmt::format("packets of a second sensor on this port are ignored, that "
                                    "at {} is followed: set udp.sensor_address",
                                    dotted(h.sensor.sensor_ipv4))))
    return;
  second_sensor_ = now;
}

// Between the first packet and the first scan there is a moment that is worth no line.
void Story::tell_flow(const Health& h) {
  const bool settled = h.flow == flow_seen_ || h.flow == Flow::no_packets || h.flow == Flow::all;
  flow_seen_ = h.flow;
  if (!settled || h.flow == flow_) return;
  bool told = false;
  switch (h.flow) {
    case Flow::no_packets:
      told = log_event(Event::sensor_silent,
                       h.source.packets == 0
                           ? std::string("no packet from the sensor yet")
                           : fmt::format("sensor silent for {:.1f} s", h.sensor_silent_s));
      break;
    case Flow::no_scans:
      // An HDL-64E without its table has a line of its own.
      told = waits_for_calibration(h.sensor) ||
             log_event(Event::no_scans, "no scans although packets come");
      break;
    case Flow::no_poses:
      told = log_event(Event::no_poses, "no poses although scans come");
      break;
    case Flow::all:
      told =
          log_event(Event::sensor_back,
                    flow_ == Flow::no_poses
                        ? fmt::format("poses again after {:.1f} s", seconds_since(flow_since_ns_))
                        : fmt::format("scans again after {:.1f} s", seconds_since(flow_since_ns_)));
      break;
  }
  if (!told) return;
  if (flow_ == Flow::all) flow_since_ns_ = monotonic_ns();
  flow_ = h.flow;
}

TrackingStatus Story::worst() const {
  if (poses_.lost > 0) return TrackingStatus::lost;
  if (poses_.degraded > 0) return TrackingStatus::degraded;
  if (poses_.initializing > 0) return TrackingStatus::initializing;
  return TrackingStatus::tracking;
}

std::string Story::why_degraded() const {
  constexpr std::array<const char*, 6> kAxes{"along x", "along y", "along z",
                                             "about x", "about y", "about z"};
  std::string why;
  if (poses_.weakest_from_scan <= 1.0)
    why = fmt::format(", {} the scan said {:.0f} % only",
                      kAxes[static_cast<std::size_t>(poses_.weakest_axis)],
                      100.0 * poses_.weakest_from_scan);
  if (poses_.doubtful > 0) why += ", its motion is in doubt (traffic beside the sensor)";
  if (poses_.uncertain > 0) why += ", over the last 10 m it may be off by 1 m or 3 deg";
  if (poses_.unconfirmed > 0) why += ", too few good alignments in a row";
  if (poses_.partial > 0) why += fmt::format(", {} scans with holes", poses_.partial);
  return why;
}

// Worse at once, better when it has been so for three seconds: what comes and goes is one line.
void Story::tell_tracking() {
  const TrackingStatus now = worst();
  calm_s_ = now == TrackingStatus::tracking ? calm_s_ + 1 : 0;
  if (now == tracking_) return;
  bool told = false;
  if (now == TrackingStatus::lost) {
    told = log_event(Event::lost, fmt::format("lost: {} of {} poses are the prediction alone",
                                              poses_.lost, poses_.all));
  } else if (now == TrackingStatus::degraded && tracking_ != TrackingStatus::lost) {
    told = log_event(Event::degraded, fmt::format("degraded: {} of {} poses{}", poses_.degraded,
                                                  poses_.all, why_degraded()));
  } else {
    tell_better(now);
    return;
  }
  if (!told) return;
  if (tracking_ == TrackingStatus::tracking || tracking_ == TrackingStatus::initializing)
    bad_since_ns_ = monotonic_ns();
  tracking_ = now;
}

void Story::tell_better(TrackingStatus now) {
  const bool first = tracking_ == TrackingStatus::initializing;
  if (tracking_ == TrackingStatus::lost && found_.lost_poses > 0) {
    if (log_event(Event::relocalized,
                  fmt::format("place found again after {} lost poses, {:.2f} m and {:.1f} deg from "
                              "the prediction: {}",
                              found_.lost_poses, found_.distance_m,
                              found_.angle_rad * 180.0 / std::numbers::pi, to_string(now)))) {
      tracking_ = now;
      found_ = {};
    }
  } else if (now == TrackingStatus::tracking && (first || calm_s_ >= kCalmForS)) {
    if (log_event(Event::tracking, first ? std::string("tracking")
                                         : fmt::format("tracking again after {:.0f} s",
                                                       seconds_since(bad_since_ns_))))
      tracking_ = now;
  }
}

void Story::tell_calibration(const SensorStatus& sensor) {
  if (waits_for_calibration(sensor)) {
    log_event(Event::calibration_waiting,
              fmt::format("waiting for the calibration in the sensor's packets, {:.0f} %",
                          100.0 * sensor.calibration_progress));
    return;
  }
  if (sensor.calibration == calibration_) return;
  calibration_ = sensor.calibration;
  if (calibration_ == CalibrationOrigin::packets)
    log_event(Event::calibration_read, "calibration read from the sensor's packets");
}

void Story::tell_clients(const Health& h) {
  if (h.clients_refused == clients_refused_) return;
  if (log_event(Event::client_refused,
                fmt::format("{} subscription(s) refused, {} clients are served: "
                            "subscribe.max_clients",
                            h.clients_refused - clients_refused_, h.clients)))
    clients_refused_ = h.clients_refused;
}

void Story::tell_clock(const Health& h) {
  if (h.clock_steps == clock_steps_) return;
  clock_steps_ = h.clock_steps;
  log_event(Event::clock_set,
            fmt::format("the computer's clock was set by {:+.3f} s", h.clock_step_s));
}

// The first at once, those that go on in sums of ten seconds.
void Story::tell_faults(const Health& h) {
  if (monotonic_ns() - faults_told_ns_ < kFaultsEveryNs) return;
  std::string text;
  for (std::size_t k = 0; k < kFaultCount; ++k) {
    const auto fault = static_cast<Fault>(k);
    // These have lines of their own.
    if (fault == Fault::clock_steps || fault == Fault::foreign_packets ||
        fault == Fault::wrong_sensor_packets)
      continue;
    const std::uint64_t now = h.totals[fault], before = faults_[fault];
    if (now > before)
      fmt::format_to(std::back_inserter(text), "{}{} {}", text.empty() ? "" : ", ",
                     words(complaint_of(fault)), now - before);
  }
  if (text.empty() || !log_event(Event::faults, text)) return;
  faults_ = h.totals;
  faults_told_ns_ = monotonic_ns();
}

}  // namespace lilo
