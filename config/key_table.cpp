#include "config/key.hpp"
#include "config/key_builders.hpp"
#include "config/text_forms.hpp"

// The member of Config that a key sets. (The name of a member cannot stand in parentheses.)
#define LILO_MEMBER(name) [](Config & c) -> auto& { return c.name; }  // NOLINT

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
      choice("sensor.model", LILO_MEMBER(sensor.model), {"auto", "vlp16", "hdl64e"}, kRestart,
             "The sensor; auto finds out from its packets."),
      text("sensor.calibration_file", LILO_MEMBER(sensor.calibration_file), kOptionalPath, kRestart,
           "HDL-64E: the unit's calibration (db.xml or the ROS YAML form), relative to this file. "
           "Empty: collected from the status bytes of the packets, which takes about 4 s."),
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
      integer("udp.receive_buffer_bytes", LILO_MEMBER(udp.receive_buffer_bytes), 65536, 268435456,
              "B", kRestart,
              "Socket buffer asked of the kernel, which grants no more than net.core.rmem_max. Two "
              "revolutions or more."),
  };
}

std::vector<Key> odometry_keys() {
  return {
      real("odometry.min_range_m", LILO_MEMBER(odometry.min_range_m), 0.0, 20.0, "m", kRestart,
           "Nearer returns are not used for odometry."),
      real("odometry.max_range_m", LILO_MEMBER(odometry.max_range_m), 5.0, 300.0, "m", kRestart,
           "Farther returns are not used, and the map is cropped there."),
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

std::vector<Key> realtime_keys() {
  return {
      integer("realtime.worker_cpu", LILO_MEMBER(realtime.worker_cpu), -1, 1023, "", kRestart,
              "Pins the odometry thread to this core; -1: not pinned."),
      integer("realtime.worker_priority", LILO_MEMBER(realtime.worker_priority), 0, 99, "",
              kRestart,
              "SCHED_FIFO priority of the odometry thread, the receiver one above; 0: the normal "
              "policy. Below 50 stays below the kernel's interrupt threads."),
      boolean("realtime.lock_memory", LILO_MEMBER(realtime.lock_memory), kRestart,
              "Locks all memory (mlockall), so that no page fault delays a pose."),
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
      {"publish", "Where poses go."},
      {"realtime", "Real-time measures. One that the system refuses is a warning, not an error."},
  };
}

std::vector<Key> config_keys() {
  std::vector<Key> keys;
  for (auto section : {sensor_keys, udp_keys, odometry_keys, publish_keys, realtime_keys}) {
    for (Key& key : section()) keys.push_back(std::move(key));
  }
  return keys;
}

}  // namespace lilo
