// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/engine.hpp"
#include "daemon/health.hpp"
#include "daemon/recent_faults.hpp"

#include <cstdint>
#include <string>

namespace lilo {

/// What the publisher did, as only it knows.
struct PublisherCounts {
  std::uint64_t poses_sent = 0, poses_not_sent = 0, send_errors = 0;
  std::size_t clients = 0;
  std::uint64_t clients_refused = 0;
  std::uint64_t packets_sent = 0, packets_not_sent = 0;  ///< of the sensor, to subscribers
};

/// How this daemon is called among those of one computer: the configuration file's name without its
/// ending, "front" of /etc/lilod/front.yaml. What is no letter, digit, _, - or . becomes _.
std::string instance_name(const std::string& config_path);

/// Gathers what health says. Lives on the publisher's thread.
class HealthMonitor {
 public:
  explicit HealthMonitor(const Engine& engine, std::string instance = "lilod");

  void started(const RealtimeReport& report);
  /// Each pose as it is published.
  void add(const PoseReport& report, double latency_ms);
  void config_was_bad(bool bad) { config_error_ = bad; }
  void metrics_failed() { metrics_error_ = true; }
  /// Once a second. Allocates nothing when `h` has been through it before.
  void collect(const PublisherCounts& published, Health& h);

 private:
  void note_clock_step(std::int64_t now_ns);
  void collect_time(std::int64_t now_ns, Health& h) const;
  void collect_counts(const PublisherCounts& published, Health& h) const;
  void collect_timing(Health& h) const;
  void collect_beams(Health& h);

  const Engine& engine_;
  std::string instance_;
  std::int64_t start_ns_;
  RealtimeReport realtime_;
  ReceiverState received_;
  BeamEstimate beams_;
  RecentFaults recent_;
  RecentValues latency_ms_, processing_ms_;
  std::array<RecentValues, kStageCount> stages_ms_;
  TrackingStatus tracking_ = TrackingStatus::initializing;
  ClockSource clock_ = ClockSource::host;
  double tilt_rad_ = 0.0;
  std::int64_t last_pose_ns_ = 0;  // 0: none yet
  std::uint64_t reports_ = 0;
  std::uint64_t faults_when_warm_ = 0, faults_now_ = 0, major_faults_at_start_ = 0;
  std::uint64_t map_refused_ = 0, map_refused_last_ = 0;
  std::uint64_t poses_at_last_look_ = 0;
  std::int64_t last_look_ns_;
  std::int64_t utc_offset_ns_;  // of the computer's UTC from its monotonic clock
  std::uint64_t clock_steps_ = 0;
  double clock_step_s_ = 0.0;
  bool config_error_ = false, metrics_error_ = false;
};

}  // namespace lilo
