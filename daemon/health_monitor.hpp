#pragma once

#include "daemon/engine.hpp"
#include "daemon/health.hpp"

#include <cstdint>

namespace lilo {

/// What the publisher did, as only it knows.
struct PublisherCounts {
  std::uint64_t poses_sent = 0, poses_not_sent = 0, send_errors = 0;
  std::size_t clients = 0;
};

/// Gathers what health says. Lives on the publisher's thread.
class HealthMonitor {
 public:
  explicit HealthMonitor(const Engine& engine);

  void started(const RealtimeReport& report);
  /// Each pose as it is published.
  void add(const PoseReport& report, double latency_ms);
  void config_was_bad(bool bad) { config_error_ = bad; }
  void metrics_failed() { metrics_error_ = true; }
  /// Once a second. Allocates nothing when `h` has been through it before.
  void collect(const PublisherCounts& published, Health& h);

 private:
  const Engine& engine_;
  std::int64_t start_ns_;
  RealtimeReport realtime_;
  RecentValues latency_ms_, processing_ms_;
  std::array<RecentValues, kStageCount> stages_ms_;
  TrackingStatus status_ = TrackingStatus::initializing;
  ClockSource clock_ = ClockSource::host;
  std::uint64_t reports_ = 0;
  std::uint64_t faults_when_warm_ = 0, faults_now_ = 0, major_faults_at_start_ = 0;
  std::uint64_t map_refused_ = 0, map_refused_last_ = 0;
  std::uint64_t poses_at_last_look_ = 0;
  std::int64_t last_look_ns_;
  bool config_error_ = false, metrics_error_ = false;
};

}  // namespace lilo
