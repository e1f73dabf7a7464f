// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/publisher.hpp"

#include "daemon/base_frame.hpp"
#include "daemon/clock.hpp"
#include "daemon/log.hpp"
#include "daemon/map_file.hpp"
#include "daemon/metrics_file.hpp"
#include "daemon/points_message.hpp"
#include "daemon/prometheus.hpp"

#include <fmt/format.h>

#include <utility>

namespace lilo {

Publisher::Publisher(boost::asio::io_context& io, const Config& config, Engine& engine,
                     HealthMonitor& monitor, Story& story)
    : config_(config),
      engine_(engine),
      monitor_(monitor),
      story_(story),
      message_{new_session(), config.publish.frame_id, config.publish.child_frame_id},
      T_base_sensor_(to_pose(config.publish.T_base_sensor)),
      mounted_(!is_identity(config.publish.T_base_sensor)),
      record_(static_cast<std::size_t>(config.state.trajectory_poses)),
      metrics_path_(metrics_path(config.health.metrics_file)),
      sinks_(io),
      server_(io, config.subscribe, config.publish,
              {.last_pose = [this] { return last_pose_; },
               .health = [this] { return write_health_now(); },
               .reset = [this](const std::optional<Pose>& start) { return reset(start); },
               .save = [this](SaveKind kind, const SaveDone& done) { save(kind, done); },
               .session = [this]() -> const std::string& { return message_.session; },
               .packets_asked = [this] { packet_sender_.start(); }}),
      packet_sender_(io, engine, server_, [this] { send_poses(); }),
      saver_(io) {
  sinks_.set(config.publish.sinks);
}

void Publisher::configure(const Config& config) {
  config_ = config;
  sinks_.set(config.publish.sinks);
  server_.configure(config.subscribe);
  metrics_path_ = metrics_path(config.health.metrics_file);
}

void Publisher::take_reports() {
  // In this order: the poses before the map are of its session.
  std::optional<MapCopy> map = engine_.take_map();
  send_poses();
  send_points();
  if (map) save_map(std::move(*map));
}

void Publisher::send_poses() {
  ReportRing& reports = engine_.reports();
  while (const PoseReport* report = reports.front()) {
    send_pose(*report);
    reports.release();
  }
}

void Publisher::send_pose(const PoseReport& report) {
  follow_session(report);
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
    record_.add(placed.estimate.stamp_ns, pose);
    ++poses_sent_;
  }
  monitor_.add(report, static_cast<double>(now_ns - report.last_packet_ns) * 1e-6);
  story_.note(report);
}

// After the poses, which are urgent. Of another session than the last pose they would be of no use.
void Publisher::send_points() {
  engine_.want_points(server_.has_points_clients());
  PointsRing& ring = engine_.points();
  while (PointsReport* report = ring.front()) {
    if (report->resets == resets_ && report->restarts == restarts_) send_points_of(*report);
    ring.release();
  }
}

void Publisher::send_points_of(PointsReport& report) {
  const PointsContext context{message_.session, report.stamp_ns, report.seq};
  const auto send = [&](PointSet set, std::vector<Eigen::Vector3f>& points_m) {
    if (mounted_) {
      for (Eigen::Vector3f& p_m : points_m)
        p_m = (T_base_sensor_ * p_m.cast<double>()).cast<float>();
    }
    for (std::size_t k = 0; k < points_datagrams(points_m.size()); ++k)
      server_.send_points(write_points(context, set, points_m, k, points_json_));
  };
  send(PointSet::scan, report.scan_m);
  send(PointSet::map, report.map_m);
}

bool Publisher::reset(const std::optional<Pose>& start_pose) {
  if (!engine_.reset()) return false;
  next_start_ = start_pose;
  return true;
}

// A pose never jumps within a session: a new origin is a new session, and so is a map that was
// begun where only the prediction knew to be.
void Publisher::follow_session(const PoseReport& report) {
  const bool reset = report.resets != resets_;
  if (!reset && report.estimate.restarts == restarts_) return;
  if (reset) {
    T_odom_start_ = next_start_.value_or(Pose{});
    next_start_.reset();
  }
  resets_ = report.resets;
  restarts_ = report.estimate.restarts;
  const std::string before = message_.session;
  renew_session(message_.session);
  record_.clear();
  set_log_context(message_.session, to_string(report.estimate.status));
  story_.session_replaced(before, message_.session, reset);
}

void Publisher::save(SaveKind kind, const SaveDone& answer) {
  const SaveDone done = [answer](const SaveResult& result) {
    if (result.error.empty()) {
      log_event(Event::saved, fmt::format("{}: {} saved", result.file, result.count));
    } else {
      log_event(Event::not_saved, fmt::format("not saved: {}", result.error));
    }
    answer(result);
  };
  if (state_directory(config_.state.directory).empty()) {
    done({.error = "no state directory: set state.directory, or run under systemd"});
  } else if (map_saved_ || saver_.busy()) {
    done({.error = "something is being saved"});
  } else if (kind == SaveKind::trajectory) {
    save_trajectory(done);
  } else {
    map_saved_ = done;
    engine_.ask_map();
  }
}

void Publisher::save_trajectory(const SaveDone& done) {
  std::vector<RecordedPose> poses = record_.copy();
  const std::size_t count = poses.size();
  const std::string comment = "lilod session " + message_.session + ", " + message_.child_frame_id +
                              " in " + message_.frame_id +
                              ", older poses forgotten: " + std::to_string(record_.forgotten());
  saver_.write(
      state_directory(config_.state.directory) + "/trajectory.tum", count,
      [poses = std::move(poses), comment] { return to_tum(poses, comment); }, done);
}

// The points go where the poses of the session are.
void Publisher::save_map(MapCopy map) {
  const SaveDone done = std::exchange(map_saved_, {});
  if (map.resets != resets_) {
    done({.error = "a reset came in between"});
    return;
  }
  const Pose T_odom_map = T_odom_start_ * T_base_sensor_;
  const std::size_t count = map.points_m.size();
  saver_.write(
      state_directory(config_.state.directory) + "/map.pcd", count,
      [map = std::move(map), T_odom_map] { return to_pcd(map.points_m, T_odom_map); }, done);
}

void Publisher::broadcast(std::string_view datagram) {
  sinks_.send(datagram);
  server_.send(datagram);
}

PublisherCounts Publisher::counts() const {
  return {.poses_sent = poses_sent_,
          .poses_not_sent = poses_not_sent_,
          .send_errors = sinks_.send_errors() + server_.send_errors(),
          .clients = server_.clients(),
          .clients_refused = server_.clients_refused(),
          .packets_sent = server_.packets_sent(),
          .packets_not_sent = server_.packets_not_sent()};
}

std::string_view Publisher::write_health_now() {
  return write_health(message_.session, health_, health_json_);
}

void Publisher::tick() {
  server_.tick();
  monitor_.collect(counts(), health_);
  if (config_.health.publish) broadcast(write_health_now());
  write_prometheus(message_.session, health_, metrics_);
  note_metrics(metrics_writer_.write(metrics_path_, metrics_));
}

void Publisher::note_metrics(std::error_code error) {
  if (error) monitor_.metrics_failed();
  if (error && error != metrics_error_)
    log_event(Event::not_saved,
              fmt::format("not saved: cannot write {}: {}", metrics_path_, error.message()));
  metrics_error_ = error;
}

}  // namespace lilo
