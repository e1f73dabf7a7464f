// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/health_monitor.hpp"

#include "daemon/clock.hpp"
#include "daemon/complaints.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <numbers>
#include <sys/resource.h>
#include <unistd.h>
#include <utility>

namespace lilo {
namespace {

constexpr std::uint64_t kWarmAfterScans = 10;
// A revolution takes 0.2 s at the slowest (300 rpm).
constexpr double kSilentAfterS = 1.0, kNoScansAfterS = 1.5, kNoPosesAfterS = 2.0;
constexpr std::int64_t kClockStepNs = 100'000'000;
constexpr std::size_t kLongestInstance = 32;
constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

std::uint64_t major_faults() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_majflt);
}

// The second number of /proc/self/statm, in pages. By read(2), because a stream allocates.
double resident_mb() {
  std::array<char, 64> text{};
  const int fd = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (fd < 0) return 0.0;
  const ssize_t size = read(fd, text.data(), text.size());
  close(fd);
  const char* const end = text.data() + std::max<ssize_t>(size, 0);
  const char* const space = std::find(std::as_const(text).data(), end, ' ');
  long pages = 0;
  if (space != end) std::from_chars(space + 1, end, pages);
  return static_cast<double>(pages) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576.0;
}

}  // namespace

std::string instance_name(const std::string& config_path) {
  std::string name = std::filesystem::path(config_path).stem().string();
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  std::replace_if(
      name.begin(), name.end(), [&](char c) { return !allowed(c); }, '_');
  return name.substr(0, kLongestInstance);
}

HealthMonitor::HealthMonitor(const Engine& engine, std::string instance)
    : engine_(engine),
      instance_(std::move(instance)),
      start_ns_(monotonic_ns()),
      last_look_ns_(start_ns_),
      utc_offset_ns_(realtime_ns() - start_ns_) {}

void HealthMonitor::started(const RealtimeReport& report) {
  realtime_ = report;
  major_faults_at_start_ = major_faults();
}

void HealthMonitor::add(const PoseReport& report, double latency_ms) {
  tracking_ = report.estimate.status;
  last_pose_ns_ = monotonic_ns();
  clock_ = report.clock;
  tilt_rad_ = report.tilt_rad;
  const std::uint64_t refused = report.estimate.map_refused_count;
  // After a reset another odometry counts, from 0.
  map_refused_ += refused >= map_refused_last_ ? refused - map_refused_last_ : refused;
  map_refused_last_ = refused;
  latency_ms_.add(latency_ms);
  processing_ms_.add(static_cast<double>(report.processing_ns) * 1e-6);
  for (std::size_t k = 0; k < stages_ms_.size(); ++k)
    stages_ms_[k].add(static_cast<double>(report.stage_ns[k]) * 1e-6);
  faults_now_ = report.worker_minor_faults;
  if (++reports_ <= kWarmAfterScans) faults_when_warm_ = faults_now_;
}

// The clock is slewed by at most 1e-3 (adjtime(3), chrony); more in a second than a tenth of one
// is a step.
void HealthMonitor::note_clock_step(std::int64_t now_ns) {
  const std::int64_t offset_ns = realtime_ns() - now_ns;
  if (std::abs(offset_ns - utc_offset_ns_) > kClockStepNs) {
    ++clock_steps_;
    clock_step_s_ = static_cast<double>(offset_ns - utc_offset_ns_) * 1e-9;
  }
  utc_offset_ns_ = offset_ns;
}

void HealthMonitor::collect_time(std::int64_t now_ns, Health& h) const {
  const auto age_s = [&](std::int64_t then_ns) {
    return static_cast<double>(now_ns - (then_ns > 0 ? then_ns : start_ns_)) * 1e-9;
  };
  h.stamp_ns = realtime_ns();
  h.uptime_s = age_s(start_ns_);
  h.sensor_silent_s = std::max(age_s(engine_.receiver().last_packet_ns()), 0.0);
  h.pose_age_s = last_pose_ns_ > 0 ? age_s(last_pose_ns_) : -1.0;
  h.flow = Flow::all;
  if (h.sensor_silent_s > kSilentAfterS) {
    h.flow = Flow::no_packets;
  } else if (age_s(engine_.receiver().last_scan_ns()) > kNoScansAfterS) {
    h.flow = Flow::no_scans;
  } else if (age_s(last_pose_ns_) > kNoPosesAfterS && engine_.scans_waiting() > 0) {
    h.flow = Flow::no_poses;
  }
}

void HealthMonitor::collect_counts(const PublisherCounts& published, Health& h) const {
  const PipelineCounters& counters = engine_.counters();
  h.sensor = received_.sensor;
  h.driver = received_.driver;
  h.source = received_.source;
  h.scans_processed = counters.scans_processed;
  h.scans_dropped = counters.scans_overrun + counters.scans_skipped;
  h.map_refused = map_refused_;
  h.poses_sent = published.poses_sent;
  h.poses_not_sent = published.poses_not_sent + counters.reports_dropped;
  h.send_errors = published.send_errors;
  h.clock_steps = clock_steps_;
  h.clock_step_s = clock_step_s_;
  h.clients = published.clients;
  h.clients_refused = published.clients_refused;
  h.packets_sent = published.packets_sent;
  h.packets_not_sent = published.packets_not_sent + counters.packets_dropped;
  h.ring_slots = engine_.ring_slots();
  h.ring_high_water = counters.ring_high_water;
}

void HealthMonitor::collect_timing(Health& h) const {
  h.latency_ms = latency_ms_.quantiles();
  h.processing_ms = processing_ms_.quantiles();
  for (std::size_t k = 0; k < stages_ms_.size(); ++k) h.stages_ms[k] = stages_ms_[k].quantiles();
  h.realtime = realtime_;
  h.worker_minor_faults = faults_now_ - faults_when_warm_;
  h.major_faults = major_faults() - major_faults_at_start_;
  h.resident_mb = resident_mb();
}

void HealthMonitor::collect_beams(Health& h) {
  engine_.beams().load(beams_);  // overtaken: those of a second ago
  h.has_beams = beams_.ring_count > 0;
  h.beams_elevation_deg = largest_elevation_rad(beams_) * kDegreesPerRadian;
  h.beams_azimuth_deg = largest_azimuth_rad(beams_) * kDegreesPerRadian;
}

void HealthMonitor::collect(const PublisherCounts& published, Health& h) {
  const std::int64_t now_ns = monotonic_ns();
  const double elapsed_s = static_cast<double>(now_ns - last_look_ns_) * 1e-9;
  engine_.receiver().state().load(received_);  // overtaken: that of a second ago
  note_clock_step(now_ns);
  h.instance = instance_;
  h.tracking = tracking_;
  h.clock = clock_;
  h.tilt_deg = tilt_rad_ * kDegreesPerRadian;
  collect_time(now_ns, h);
  collect_counts(published, h);
  collect_timing(h);
  collect_beams(h);
  const auto new_poses = static_cast<double>(published.poses_sent - poses_at_last_look_);
  h.rate_hz = elapsed_s > 0.0 ? new_poses / elapsed_s : 0.0;
  h.totals = fault_totals(h);
  h.recent = recent_.see(h.totals, now_ns);
  h.config_error = config_error_;
  h.metrics_error = std::exchange(metrics_error_, false);
  poses_at_last_look_ = published.poses_sent;
  last_look_ns_ = now_ns;
}

}  // namespace lilo
