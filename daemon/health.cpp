// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/health.hpp"

#include "daemon/complaints.hpp"
#include "daemon/message_head.hpp"
#include "daemon/pose_message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace lilo {
namespace {

/// How much of what may go a datagram has.
struct Room {
  bool stages, sensor;
  std::size_t complaints;
};
constexpr std::array<Room, 6> kRooms{{{true, true, kComplaintCount},
                                      {false, true, kComplaintCount},
                                      {false, true, 8},
                                      {false, true, 4},
                                      {false, false, 4},
                                      {false, false, 0}}};

void write_quantiles(JsonWriter& out, std::string_view name, const Quantiles& q) {
  out.begin_object(name);
  out.number("p50", q.p50, 2);
  out.number("p99", q.p99, 2);
  out.number("max", q.max, 2);
  out.end_object();
}

void write_packets(JsonWriter& out, const Health& h) {
  out.begin_object("packets");
  out.unsigned_integer("received", h.driver.data_packets);
  out.unsigned_integer("lost", h.driver.packets_lost);
  out.unsigned_integer("kernel_dropped", h.source.kernel_dropped);
  out.unsigned_integer("malformed", h.driver.malformed_packets);
  out.unsigned_integer("duplicated", h.driver.packets_duplicated);
  out.unsigned_integer("reordered", h.driver.packets_reordered);
  out.unsigned_integer("foreign", h.driver.foreign_packets);
  out.unsigned_integer("wrong_sensor", h.driver.wrong_sensor_packets);
  out.end_object();
}

void write_scans(JsonWriter& out, const Health& h) {
  out.begin_object("scans");
  out.unsigned_integer("complete", h.driver.scans_complete);
  out.unsigned_integer("partial", h.driver.scans_partial);
  out.unsigned_integer("processed", h.scans_processed);
  out.unsigned_integer("dropped", h.scans_dropped);
  out.unsigned_integer("ring_high_water", h.ring_high_water);
  out.unsigned_integer("ring_slots", h.ring_slots);
  out.end_object();
}

void write_realtime(JsonWriter& out, const Health& h) {
  out.begin_object("realtime");
  out.boolean("as_configured", h.realtime.refusals.empty());
  out.text("policy", h.realtime.worker.policy);
  out.integer("priority", h.realtime.worker.priority);
  out.text("cpus", h.realtime.worker.cpus);
  out.integer("locked_kb", h.realtime.locked_memory_kb);
  out.unsigned_integer("worker_minor_faults", h.worker_minor_faults);
  out.unsigned_integer("major_faults", h.major_faults);
  out.number("resident_mb", h.resident_mb, 1);
  out.end_object();
}

// Nothing of it before a packet has told.
void write_sensor(JsonWriter& out, const SensorStatus& sensor) {
  if (sensor.model == SensorModel::automatic) return;
  const std::uint32_t ip = sensor.sensor_ipv4;
  std::array<char, 16> address{};
  fmt::format_to_n(address.data(), address.size() - 1, "{}.{}.{}.{}", ip >> 24U, ip >> 16U & 0xffU,
                   ip >> 8U & 0xffU, ip & 0xffU);
  out.begin_object("sensor");
  out.text("model", to_string(sensor.model));
  out.text("address", address.data());
  out.number("rpm", sensor.rpm, 0);
  out.text("returns", to_string(sensor.return_mode));
  out.end_object();
}

void write_tilt(JsonWriter& out, const Health& h) {
  if (h.tilt_deg > 0.0) out.number("tilt_deg", h.tilt_deg, 1);
}

void write_beams(JsonWriter& out, const Health& h) {
  if (!h.has_beams) return;
  out.begin_object("beams");
  out.number("elevation_deg", h.beams_elevation_deg, 3);
  out.number("azimuth_deg", h.beams_azimuth_deg, 3);
  out.end_object();
}

void write_complaints(JsonWriter& out, const Health& h, std::size_t at_most) {
  const Complaints all = complaints(h);
  WordsBuffer buffer;
  out.begin_array("complaints");
  for (std::size_t k = 0; k < std::min(all.size(), at_most); ++k)
    out.item(words(all[k], h, buffer));
  if (all.size() > at_most) out.item("more");
  out.end_array();
}

void write_state(JsonWriter& out, const Health& h, const Room& room) {
  out.text("status", status_word(h));
  write_complaints(out, h, room.complaints);
  out.text("instance", h.instance);
  out.number("uptime_s", h.uptime_s, 1);
  out.number("rate_hz", h.rate_hz, 1);
  if (h.pose_age_s >= 0.0) out.number("pose_age_s", h.pose_age_s, 1);
  out.text("clock", to_string(h.clock));
  out.number("sensor_silent_s", h.sensor_silent_s, 1);
  if (room.sensor) {
    write_sensor(out, h.sensor);
    write_tilt(out, h);
    write_beams(out, h);
  }
}

std::string_view write(const std::string& session, const Health& h, const Room& room,
                       JsonWriter& out) {
  begin_message(out, h.stamp_ns, session);
  out.begin_object("health");
  write_state(out, h, room);
  write_packets(out, h);
  write_scans(out, h);
  out.unsigned_integer("map_refused", h.map_refused);
  out.unsigned_integer("poses_sent", h.poses_sent);
  out.unsigned_integer("poses_not_sent", h.poses_not_sent);
  out.unsigned_integer("send_errors", h.send_errors);
  out.unsigned_integer("receive_errors", h.source.receive_errors);
  out.unsigned_integer("sensor_restarts", h.driver.sensor_restarts);
  out.unsigned_integer("clock_steps", h.clock_steps);
  out.unsigned_integer("clients", h.clients);
  out.unsigned_integer("clients_refused", h.clients_refused);
  write_quantiles(out, "latency_ms", h.latency_ms);
  write_quantiles(out, "processing_ms", h.processing_ms);
  write_realtime(out, h);
  if (room.stages) {
    out.begin_object("stages_ms");
    for (std::size_t k = 0; k < h.stages_ms.size(); ++k)
      out.number(to_string(static_cast<Stage>(k)), h.stages_ms[k].p50, 2);
    out.end_object();
  }
  out.end_object();
  return out.finish();
}

}  // namespace

const char* to_string(ClockSource clock) {
  switch (clock) {
    case ClockSource::host:
      return "host";
    case ClockSource::gps:
      return "gps";
    case ClockSource::replay:
      return "replay";
  }
  return "host";
}

const char* to_string(SensorModel model) {
  switch (model) {
    case SensorModel::automatic:
      return "";
    case SensorModel::vlp16:
      return "vlp16";
    case SensorModel::hdl64e:
      return "hdl64e";
    case SensorModel::vlp32c:
      return "vlp32c";
    case SensorModel::hdl32e:
      return "hdl32e";
    case SensorModel::vls128:
      return "vls128";
  }
  return "";
}

const char* to_string(ReturnMode mode) {
  switch (mode) {
    case ReturnMode::strongest:
      return "strongest";
    case ReturnMode::last:
      return "last";
    case ReturnMode::dual:
      return "dual";
  }
  return "strongest";
}

const char* status_word(const Health& h) {
  switch (h.flow) {
    case Flow::all:
      return to_string(h.tracking);
    case Flow::no_packets:
      return "silent";
    case Flow::no_scans:
      return "no_scans";
    case Flow::no_poses:
      return "no_poses";
  }
  return "silent";
}

bool waits_for_calibration(const SensorStatus& sensor) {
  return sensor.model == SensorModel::hdl64e && sensor.calibration == CalibrationOrigin::none;
}

std::string_view write_health(const std::string& session, const Health& health, JsonWriter& out) {
  std::string_view text;
  for (const Room& room : kRooms) {
    text = write(session, health, room, out);
    if (!text.empty()) break;
  }
  return text;
}

}  // namespace lilo
