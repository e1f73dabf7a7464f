// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/odometry_config.hpp"
#include "drivers/packet_source.hpp"
#include "drivers/sensor_config.hpp"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace lilo {

/// Where the sensor sits on the robot: its position in the base frame, and the rotation that turns
/// sensor axes into base axes, as roll, pitch and yaw about the fixed base axes (REP-103).
struct MountConfig {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  double roll_rad = 0.0, pitch_rad = 0.0, yaw_rad = 0.0;
};

/// Where poses go.
struct PublishConfig {
  std::vector<std::string> sinks;           ///< "host:port", one datagram a pose to each
  std::string frame_id = "odom";            ///< parent frame, REP-105
  std::string child_frame_id = "velodyne";  ///< the frame whose pose is published
  MountConfig T_base_sensor;                ///< identity: the pose of the sensor is published
};

/// Who may ask for poses.
struct SubscribeConfig {
  std::string bind_address = "127.0.0.1";
  std::uint16_t port = 9871;       ///< 0: nobody can ask
  std::vector<std::string> allow;  ///< addresses and CIDR ranges besides loopback
  int max_clients = 16;
  double lease_s = 5.0;     ///< longest, and the one granted when none is asked for
  int points_clients = 4;   ///< subscribers that may have points; 0: none
  int scan_points = 600;    ///< most points a scan they get of what it was aligned by,
  int map_points = 500;     ///< and of what it added to the map
  int packets_clients = 0;  ///< subscribers that may have the sensor's packets; 0: none
};

/// What the daemon keeps.
struct StateConfig {
  std::string directory;         ///< empty: systemd's state directory, or none
  int trajectory_poses = 36000;  ///< poses it remembers, for saving
};

enum class LogLevel : std::uint8_t { debug, info, warning, error };

/// What goes to the journal.
struct LogConfig {
  LogLevel level = LogLevel::info;  ///< this and worse
};

/// What the daemon says of itself.
struct HealthConfig {
  bool publish = true;       ///< a datagram a second to all sinks and clients
  std::string metrics_file;  ///< for Prometheus; empty: lilo.prom in systemd's runtime directory
};

/// Real-time measures, each of them optional.
struct RealtimeConfig {
  int worker_cpu = -1;       ///< pin the worker here; -1: do not pin
  int worker_priority = 0;   ///< SCHED_FIFO priority; 0: the normal policy
  bool lock_memory = false;  ///< mlockall
  int reserve_mb = 1;        ///< heap held beforehand when memory is locked
  int ring_slots = 4;        ///< scans the ring can hold
};

struct Config {
  SensorConfig sensor;
  UdpConfig udp;
  OdometryConfig odometry;
  PublishConfig publish;
  SubscribeConfig subscribe;
  HealthConfig health;
  LogConfig log;
  StateConfig state;
  RealtimeConfig realtime;
};

/// A configuration that cannot be used: one line per error, "file:line:column: key: expected ...,
/// found ...", all errors at once.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Whether a file without any key will do: every key has a default.
enum class EmptyFile : std::uint8_t { allowed, refused };

/// Reads a YAML file. Throws ConfigError.
Config load_config(const std::string& path, EmptyFile empty = EmptyFile::allowed);

}  // namespace lilo
