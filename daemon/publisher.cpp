#include "daemon/publisher.hpp"

#include "daemon/base_frame.hpp"
#include "daemon/clock.hpp"
#include "daemon/metrics_file.hpp"

#include <utility>

namespace lilo {

Publisher::Publisher(boost::asio::io_context& io, const Config& config, Engine& engine,
                     HealthMonitor& monitor)
    : config_(config),
      engine_(engine),
      monitor_(monitor),
      message_{new_session(), config.publish.frame_id, config.publish.child_frame_id},
      T_base_sensor_(to_pose(config.publish.T_base_sensor)),
      mounted_(!is_identity(config.publish.T_base_sensor)),
      sinks_(io),
      server_(io, config.subscribe, config.publish,
              {.last_pose = [this] { return last_pose_; },
               .health = [this] { return write_health_now(); },
               .reset = [this](const std::optional<Pose>& start) { return reset(start); },
               .session = [this]() -> const std::string& { return message_.session; }}) {
  sinks_.set(config.publish.sinks);
}

void Publisher::configure(const Config& config) {
  config_ = config;
  sinks_.set(config.publish.sinks);
  server_.configure(config.subscribe);
}

void Publisher::send_poses() {
  ReportRing& reports = engine_.reports();
  while (const PoseReport* report = reports.front()) {
    send_pose(*report);
    reports.release();
  }
}

void Publisher::send_pose(const PoseReport& report) {
  if (report.resets != resets_) begin_session(report.resets);
  PoseReport placed = report;
  if (mounted_) placed.estimate = in_base_frame(report.estimate, T_base_sensor_);
  Pose& pose = placed.estimate.T_odom_sensor;
  if (resets_ > 0) pose = T_odom_start_ * pose;
  const std::int64_t now_ns = monotonic_ns();
  last_pose_ = write_pose(message_, placed, now_ns, pose_json_);
  if (last_pose_.empty()) {
    ++poses_not_sent_;
  } else {
    broadcast(last_pose_);
    ++poses_sent_;
  }
  monitor_.add(report, static_cast<double>(now_ns - report.last_packet_ns) * 1e-6);
}

bool Publisher::reset(const std::optional<Pose>& start_pose) {
  if (!engine_.reset()) return false;
  next_start_ = start_pose;
  return true;
}

// A pose never jumps within a session: a new origin is a new session.
void Publisher::begin_session(std::uint64_t resets) {
  resets_ = resets;
  message_.session = new_session();
  T_odom_start_ = next_start_.value_or(Pose{});
  next_start_.reset();
}

void Publisher::broadcast(std::string_view datagram) {
  sinks_.send(datagram);
  server_.send(datagram);
}

PublisherCounts Publisher::counts() const {
  return {.poses_sent = poses_sent_,
          .poses_not_sent = poses_not_sent_,
          .send_errors = sinks_.send_errors() + server_.send_errors(),
          .clients = server_.clients()};
}

std::string_view Publisher::write_health_now() {
  return write_health(message_.session, health_, health_json_);
}

void Publisher::tick() {
  server_.tick();
  health_ = monitor_.collect(counts());
  if (config_.health.publish) broadcast(write_health_now());
  const std::string path = metrics_path(config_.health.metrics_file);
  if (!path.empty() && !replace_file(path, to_prometheus(message_.session, health_)))
    monitor_.metrics_failed();
}

}  // namespace lilo
