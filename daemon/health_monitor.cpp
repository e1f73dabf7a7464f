#include "daemon/health_monitor.hpp"

#include "daemon/clock.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>
#include <utility>

namespace lilo {
namespace {

constexpr std::uint64_t kWarmAfterScans = 10;

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

HealthMonitor::HealthMonitor(const Engine& engine)
    : engine_(engine), start_ns_(monotonic_ns()), last_look_ns_(start_ns_) {}

void HealthMonitor::started(const RealtimeReport& report) {
  realtime_ = report;
  major_faults_at_start_ = major_faults();
}

void HealthMonitor::add(const PoseReport& report, double latency_ms) {
  status_ = report.estimate.status;
  clock_ = report.clock;
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

void HealthMonitor::collect(const PublisherCounts& published, Health& h) {
  const std::int64_t now_ns = monotonic_ns();
  const PipelineCounters& counters = engine_.counters();
  const std::int64_t last_packet_ns = engine_.receiver().last_packet_ns();
  const double elapsed_s = static_cast<double>(now_ns - last_look_ns_) * 1e-9;
  h.stamp_ns = realtime_ns();
  h.uptime_s = static_cast<double>(now_ns - start_ns_) * 1e-9;
  h.status = status_;
  h.clock = clock_;
  h.sensor_silent_s =
      static_cast<double>(now_ns - (last_packet_ns > 0 ? last_packet_ns : start_ns_)) * 1e-9;
  h.calibration_progress = engine_.receiver().calibration_progress();
  h.driver = engine_.receiver().driver_counts().driver();
  h.source = engine_.receiver().driver_counts().source();
  h.scans_processed = counters.scans_processed;
  h.scans_dropped = counters.scans_overrun + counters.scans_skipped;
  h.map_refused = map_refused_;
  h.poses_sent = published.poses_sent;
  h.poses_not_sent = published.poses_not_sent + counters.reports_dropped;
  h.send_errors = published.send_errors;
  h.clients = published.clients;
  h.ring_slots = engine_.ring_slots();
  h.ring_high_water = counters.ring_high_water;
  const auto new_poses = static_cast<double>(published.poses_sent - poses_at_last_look_);
  h.rate_hz = elapsed_s > 0.0 ? new_poses / elapsed_s : 0.0;
  h.latency_ms = latency_ms_.quantiles();
  h.processing_ms = processing_ms_.quantiles();
  for (std::size_t k = 0; k < stages_ms_.size(); ++k) h.stages_ms[k] = stages_ms_[k].quantiles();
  h.realtime = realtime_;
  h.worker_minor_faults = faults_now_ - faults_when_warm_;
  h.major_faults = major_faults() - major_faults_at_start_;
  h.resident_mb = resident_mb();
  h.config_error = config_error_;
  h.metrics_error = metrics_error_;
  metrics_error_ = false;
  poses_at_last_look_ = published.poses_sent;
  last_look_ns_ = now_ns;
}

}  // namespace lilo
