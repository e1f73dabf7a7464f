// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/config.hpp"
#include "daemon/engine.hpp"
#include "daemon/health_monitor.hpp"
#include "daemon/metrics_writer.hpp"
#include "daemon/packet_sender.hpp"
#include "daemon/pose_message.hpp"
#include "daemon/pose_record.hpp"
#include "daemon/saver.hpp"
#include "daemon/server.hpp"
#include "daemon/sinks.hpp"
#include "daemon/story.hpp"

#include <boost/asio/io_context.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace lilo {

/// Everything the daemon sends: poses and health, to sinks, subscribers and whoever asks. Owns the
/// session. One thread; once warm it allocates for what is asked of it alone.
class Publisher {
 public:
  /// Throws std::runtime_error when a socket cannot be had.
  Publisher(boost::asio::io_context& io, const Config& config, Engine& engine,
            HealthMonitor& monitor, Story& story);

  /// Sends all poses the worker has finished, saves the map it has copied.
  void take_reports();
  /// Once a second: health, leases.
  void tick();
  /// Takes the keys that may change at run time.
  void configure(const Config& config);

  [[nodiscard]] const std::string& session() const { return message_.session; }
  [[nodiscard]] const Health& last_health() const { return health_; }

 private:
  void send_poses();
  void send_pose(const PoseReport& report);
  void send_points();
  void send_points_of(PointsReport& report);
  void save(SaveKind kind, const SaveDone& answer);
  void save_trajectory(const SaveDone& done);
  void save_map(MapCopy map);
  void follow_session(const PoseReport& report);
  bool reset(const std::optional<Pose>& start_pose);
  void note_metrics(std::error_code error);
  void broadcast(std::string_view datagram);
  std::string_view write_health_now();
  [[nodiscard]] PublisherCounts counts() const;

  Config config_;
  Engine& engine_;
  HealthMonitor& monitor_;
  Story& story_;
  PoseMessageContext message_;
  Pose T_base_sensor_;
  bool mounted_ = false;        // T_base_sensor is not the identity
  std::uint64_t resets_ = 0;    // before the session,
  std::uint32_t restarts_ = 0;  // and of its odometry
  Pose T_odom_start_;           // where the first pose of the session is
  std::optional<Pose> next_start_;
  PoseRecord record_;
  SaveDone map_saved_;  // empty: no map was asked for
  JsonWriter pose_json_, health_json_, points_json_;
  std::string_view last_pose_;
  Health health_;
  std::string metrics_path_, metrics_;
  MetricsWriter metrics_writer_;
  std::error_code metrics_error_;  // the one that was told
  std::uint64_t poses_sent_ = 0, poses_not_sent_ = 0;
  Sinks sinks_;
  Server server_;
  PacketSender packet_sender_;
  Saver saver_;
};

}  // namespace lilo
