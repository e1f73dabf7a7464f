// SPDX-License-Identifier: BSD-3-Clause
#include "config/key.hpp"
#include "config/key_builders.hpp"
#include "config/odometry_keys.hpp"
#include "config/text_forms.hpp"

namespace lilo {
namespace {

using key_builders::angle;
using key_builders::boolean;
using key_builders::choice;
using key_builders::integer;
using key_builders::list;
using key_builders::real;
using key_builders::text;

constexpr Reload kLive = Reload::live;
constexpr Reload kRestart = Reload::restart;

std::vector<Key> sensor_keys() {
  return {
      choice("sensor.model", LILO_MEMBER(sensor.model),
             {"auto", "vlp16", "hdl64e", "vlp32c", "hdl32e", "vls128"}, kRestart,
             "The sensor; auto finds out from its packets. vlp16 is the Puck LITE and the Puck "
             "Hi-Res too, vls128 the Alpha Prime. Packets of another one are refused."),
      boolean("sensor.ignore_product_byte", LILO_MEMBER(sensor.ignore_product_byte), kRestart,
              "Believe sensor.model even where the packets name another product (payload byte "
              "1205), for a sensor whose byte is wrong. Without a model, nothing is ignored."),
      text(
          "sensor.calibration_file", LILO_MEMBER(sensor.calibration_file), kOptionalPath, kRestart,
          "The unit's calibration (db.xml or the ROS YAML form), relative to this file. Empty: the "
          "model's own; HDL-64E: collected from the status bytes of the packets, which takes "
          "about 4 s."),
      angle("sensor.cut_azimuth_deg", LILO_MEMBER(sensor.cut_azimuth_rad), 0.0, 359.99, kRestart,
            "Where one scan ends and the next begins, as the sensor counts azimuth (clockwise from "
            "above). Best where the robot itself hides the view."),
      angle("sensor.max_hole_deg", LILO_MEMBER(sensor.max_hole_rad), 0.5, 180.0, kRestart,
            "A scan with a larger hole, from lost packets, is marked partial."),
      real("sensor.min_range_m", LILO_MEMBER(sensor.min_range_m), 0.0, 20.0, "m", kRestart,
           "Nearer returns are the robot itself or dust on the lens and are left out."),
      real("sensor.max_range_m", LILO_MEMBER(sensor.max_range_m), 5.0, 300.0, "m", kRestart,
           "Farther returns are left out."),
      choice("sensor.returns", LILO_MEMBER(sensor.returns), {"strongest", "last", "both"}, kRestart,
             "Which echoes of a dual-return sensor become part of the scan."),
      angle("sensor.kitti_elevation_offset_deg", LILO_MEMBER(sensor.kitti_elevation_offset_rad),
            -1.0, 1.0, kRestart,
            "KITTI folders only, for the tools: added to the elevation of every return; 0.205 "
            "corrects the data set's calibration as IMLS-SLAM found it."),
  };
}

std::vector<Key> udp_keys() {
  return {
      text("udp.bind_address", LILO_MEMBER(udp.bind_address), kAddress, kRestart,
           "Address of the network card the sensor sends to; 0.0.0.0: any. Sensors broadcast by "
           "default, which only 0.0.0.0 receives."),
      integer("udp.data_port", LILO_MEMBER(udp.data_port), 1, 65535, "", kRestart,
              "Port of the data packets."),
      integer("udp.position_port", LILO_MEMBER(udp.position_port), 0, 65535, "", kRestart,
              "Port of the position packets, which bring the GPS time; 0: do not listen."),
      text("udp.sensor_address", LILO_MEMBER(udp.sensor_address), kOptionalAddress, kRestart,
           "Only packets from this address are taken; empty: from anywhere. Set it where two "
           "sensors share a network."),
      text("udp.multicast_group", LILO_MEMBER(udp.multicast_group), kOptionalAddress, kRestart,
           "Group to join when the sensor sends multicast; empty: none."),
      boolean(
          "udp.share_ports", LILO_MEMBER(udp.share_ports), kRestart,
          "Other lilods of this computer may listen to the same ports, each to a sensor of its "
          "own. Needs sensor_address, and for sensors that do not broadcast the next two ports."),
      integer("udp.sensor_data_port", LILO_MEMBER(udp.sensor_data_port), 1, 65535, "", kRestart,
              "With share_ports: the port that the sensor sends its data packets from; 443 for "
              "many an HDL-64E."),
      integer("udp.sensor_position_port", LILO_MEMBER(udp.sensor_position_port), 1, 65535, "",
              kRestart, "The same for its position packets."),
      integer("udp.receive_buffer_bytes", LILO_MEMBER(udp.receive_buffer_bytes), 65536, 268435456,
              "B", kRestart,
              "Socket buffer asked of the kernel, which grants no more than net.core.rmem_max. Two "
              "revolutions or more."),
  };
}

std::vector<Key> publish_keys() {
  return {
      list("publish.sinks", LILO_MEMBER(publish.sinks), kEndpoint, kLive,
           "Every pose goes to each of these as one UDP datagram; multicast groups too. "
           "PlotJuggler's UDP server listens on 127.0.0.1:9870."),
      text("publish.frame_id", LILO_MEMBER(publish.frame_id), kFrameName, kRestart,
           "Name of the parent frame (REP-105)."),
      text("publish.child_frame_id", LILO_MEMBER(publish.child_frame_id), kFrameName, kRestart,
           "Name of the frame whose pose is published."),
  };
}

std::vector<Key> mount_keys() {
  const auto metres = [](const char* name, auto member, const char* meaning) {
    return real(name, member, -100.0, 100.0, "m", kRestart, meaning);
  };
  const auto degrees = [](const char* name, auto member, const char* meaning) {
    return angle(name, member, -180.0, 180.0, kRestart, meaning);
  };
  return {
      metres("publish.T_base_sensor.x_m", LILO_MEMBER(publish.T_base_sensor.x_m), "Forward."),
      metres("publish.T_base_sensor.y_m", LILO_MEMBER(publish.T_base_sensor.y_m), "To the left."),
      metres("publish.T_base_sensor.z_m", LILO_MEMBER(publish.T_base_sensor.z_m), "Up."),
      degrees("publish.T_base_sensor.roll_deg", LILO_MEMBER(publish.T_base_sensor.roll_rad),
              "Turned about x first."),
      degrees("publish.T_base_sensor.pitch_deg", LILO_MEMBER(publish.T_base_sensor.pitch_rad),
              "Then about y of the robot; positive looks down."),
      degrees("publish.T_base_sensor.yaw_deg", LILO_MEMBER(publish.T_base_sensor.yaw_rad),
              "Then about z of the robot; positive looks to the left."),
  };
}

std::vector<Key> subscribe_keys() {
  return {
      text("subscribe.bind_address", LILO_MEMBER(subscribe.bind_address), kAnyAddress, kRestart,
           "Address to listen on for requests of clients. 127.0.0.1: this computer only; 0.0.0.0: "
           "all of IPv4; \"::\": all of IPv4 and IPv6."),
      integer("subscribe.port", LILO_MEMBER(subscribe.port), 0, 65535, "", kRestart,
              "Port to listen on for requests of clients; 0: nobody can ask."),
      list("subscribe.allow", LILO_MEMBER(subscribe.allow), kAddressRange, kLive,
           "Other computers that may ask, as addresses or ranges: 10.0.0.7, 192.168.1.0/24, "
           "fd00::/8. They have to echo a token first, so that nobody can have "
           "poses sent to a third one."),
      integer("subscribe.max_clients", LILO_MEMBER(subscribe.max_clients), 1, 256, "", kRestart,
              "Subscribers at one time."),
      real("subscribe.lease_s", LILO_MEMBER(subscribe.lease_s), 1.0, 3600.0, "s", kLive,
           "A subscription ends when it is not renewed for this long."),
      integer("subscribe.points_clients", LILO_MEMBER(subscribe.points_clients), 0, 16, "",
              kRestart,
              "Subscribers at one time that may have points too, as lilo view asks for; 0: nobody. "
              "Nothing is sent or computed until one asks."),
      integer("subscribe.scan_points", LILO_MEMBER(subscribe.scan_points), 0, 4000, "points",
              kRestart,
              "Points a scan for each of them, at most, of those the scan was aligned by. 120 take "
              "a datagram of 1.2 kB."),
      integer("subscribe.map_points", LILO_MEMBER(subscribe.map_points), 0, 4000, "points",
              kRestart, "The same for those that the scan added to the map."),
      integer("subscribe.packets_clients", LILO_MEMBER(subscribe.packets_clients), 0, 4, "",
              kRestart,
              "Subscribers at one time that may have the sensor's packets too, as lilo record "
              "--packets asks for; 0: nobody. To each go 0.9 MB/s of a VLP-16, 4.3 MB/s of an "
              "HDL-64E."),
  };
}

std::vector<Key> health_keys() {
  return {
      boolean("health.publish", LILO_MEMBER(health.publish), kLive,
              "Sends a health datagram a second to all sinks and subscribers."),
      text("health.metrics_file", LILO_MEMBER(health.metrics_file), kOptionalPath, kLive,
           "File with the same for Prometheus' node_exporter, renewed every second. Empty: "
           "lilo.prom in the folder systemd gives us, or none."),
  };
}

std::vector<Key> log_keys() {
  return {
      choice("log.level", LILO_MEMBER(log.level), {"debug", "info", "warning", "error"}, kLive,
             "What goes to stderr, which is systemd's journal: this and worse. More than 50 lines "
             "in 10 s are left out and counted."),
  };
}

std::vector<Key> state_keys() {
  return {
      text(
          "state.directory", LILO_MEMBER(state.directory), kOptionalPath, kRestart,
          "Folder for what is saved on request (map.pcd, trajectory.tum), for the calibration read "
          "from an HDL-64E's packets and for the errors of the beams found while driving "
          "(beams.yaml). Empty: the one systemd gives us, or none."),
      integer("state.trajectory_poses", LILO_MEMBER(state.trajectory_poses), 0, 10000000, "poses",
              kRestart,
              "The latest poses of the session are remembered for a request to save them; 48 bytes "
              "each. The default is an hour."),
  };
}

std::vector<Key> realtime_keys() {
  return {
      integer("realtime.worker_cpu", LILO_MEMBER(realtime.worker_cpu), -1, 1023, "", kRestart,
              "Pins the odometry thread to this core; -1: not pinned."),
      integer(
          "realtime.worker_priority", LILO_MEMBER(realtime.worker_priority), 0, 99, "", kRestart,
          "SCHED_FIFO priority of the odometry thread, the receiver one above, the publisher one "
          "below; 0: the normal policy. Below 50 stays below the kernel's interrupt threads."),
      boolean("realtime.lock_memory", LILO_MEMBER(realtime.lock_memory), kRestart,
              "Locks all memory (mlockall), so that no page fault delays a pose."),
      integer("realtime.reserve_mb", LILO_MEMBER(realtime.reserve_mb), 0, 4096, "", kRestart,
              "With lock_memory: memory held for requests; a map to save is copied first (MiB)."),
      integer("realtime.ring_slots", LILO_MEMBER(realtime.ring_slots), 3, 64, "scans", kRestart,
              "Scans that may wait for the odometry thread. When all are taken, the oldest are "
              "dropped and counted."),
  };
}

}  // namespace

std::vector<Section> config_sections() {
  return {
      {"sensor", "How packets become scans."},
      {"udp", "Where packets come from."},
      {"odometry", "How scans become poses."},
      {"odometry.default", "The choices of profile default."},
      {"odometry.paper", "The choices of profile paper."},
      {"publish", "Where poses go."},
      {"publish.T_base_sensor",
       "Where the sensor sits on the robot. All zero: the pose is the sensor's own. Otherwise it "
       "is "
       "the base frame's; name that in child_frame_id."},
      {"subscribe", "Who may ask for poses."},
      {"health", "What lilod says of itself."},
      {"log", "What lilod writes to the journal."},
      {"state", "What lilod keeps."},
      {"realtime", "Real-time measures. One that the system refuses is a warning, not an error."},
  };
}

std::vector<Key> config_keys() {
  std::vector<Key> keys;
  for (auto section :
       {sensor_keys, udp_keys, odometry_keys, default_profile_keys, paper_keys, publish_keys,
        mount_keys, subscribe_keys, health_keys, log_keys, state_keys, realtime_keys}) {
    for (Key& key : section()) keys.push_back(std::move(key));
  }
  return keys;
}

}  // namespace lilo
