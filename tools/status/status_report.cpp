// SPDX-License-Identifier: BSD-3-Clause
#include "tools/status/status_report.hpp"

#include "tools/listen/pose_message.hpp"
#include "tools/message_numbers.hpp"
#include "tools/status/status_words.hpp"
#include "tools/terminal/printable.hpp"

#include <fmt/format.h>

#include <cmath>

namespace lilo {
namespace {

using nlohmann::json;

const json& section(const StatusReport& report) { return report.health.at("health"); }

/// Something whose parts are looked up with defaults: older daemons say less.
json part(const json& object, const char* name) { return object.value(name, json::object()); }

/// Worth a look as soon as it is not 0.
Colour colour_of_count(std::uint64_t count) { return count > 0 ? Colour::warning : Colour::none; }

/// "lilod 0.1.0 (vlp16) at 127.0.0.1:9871, up 12 s".
std::string daemon_words(const StatusReport& report) {
  const json& health = section(report);
  const std::string instance = health.value("instance", "");
  return fmt::format("{}{} at {}, up {}", report.software,
                     instance.empty() ? "" : fmt::format(" ({})", instance), report.address,
                     duration_words(health.value("uptime_s", 0.0)));
}

StatusRow status_row(const json& health) {
  const std::string status = health.value("status", "unknown");
  return {"Status", status, colour_of_status(status)};
}

std::string complaints_text(const json& health) {
  std::string text;
  for (const json& complaint : health.value("complaints", json::array())) {
    text += (text.empty() ? "" : ", ") + complaint.get<std::string>();
  }
  return text;
}

StatusRow complaints_row(const json& health) {
  const std::string text = complaints_text(health);
  return {"Complaints", text.empty() ? "none" : text, text.empty() ? Colour::good : Colour::bad};
}

StatusRow sensor_row(const json& health) {
  const json sensor = part(health, "sensor");
  const double silent_s = health.value("sensor_silent_s", 0.0);
  const bool silent = silent_s > 1.0;
  std::string text;
  for (const char* name : {"model", "address", "returns"}) {
    if (sensor.contains(name)) text += sensor.value(name, "") + ", ";
  }
  if (sensor.contains("rpm")) text += fmt::format("{:.0f} rpm, ", sensor.value("rpm", 0.0));
  if (silent) text += fmt::format("silent for {}, ", duration_words(silent_s));
  text += fmt::format("stamps by {}", clock_words(health.value("clock", "")));
  return {"Sensor", text, silent ? Colour::bad : Colour::none};
}

void add_tilt_row(const json& health, std::vector<StatusRow>& rows) {
  if (!health.contains("tilt_deg")) return;
  rows.push_back({"Tilt", fmt::format("{:.1f} deg against the ground of the first scan, levelled",
                                      health.value("tilt_deg", 0.0))});
}

void add_beams_row(const json& health, std::vector<StatusRow>& rows) {
  if (!health.contains("beams")) return;
  const json& beams = health["beams"];
  rows.push_back(
      {"Beams", fmt::format("corrected by up to {:.3f} deg in elevation, {:.3f} in azimuth",
                            beams.value("elevation_deg", 0.0), beams.value("azimuth_deg", 0.0))});
}

StatusRow rate_row(const json& health) {
  const double rate_hz = health.value("rate_hz", 0.0);
  return {"Pose rate", fmt::format("{:.1f} Hz", rate_hz),
          rate_hz > 0.0 ? Colour::none : Colour::bad};
}

StatusRow last_pose_row(const json& health, const PoseMessage& message) {
  std::string text =
      fmt::format("number {}, {} UTC", message.seq, time_words(message.pose.stamp_ns));
  if (health.contains("pose_age_s"))
    text += fmt::format(", {} ago", duration_words(health.value("pose_age_s", 0.0)));
  return {"Last pose", text};
}

void add_pose_rows(const StatusReport& report, std::vector<StatusRow>& rows) {
  PoseMessage message;
  if (report.pose.is_null() || parse_message(report.pose.dump(), message) != MessageKind::pose) {
    rows.push_back({"Last pose", "none yet", Colour::warning});
    return;
  }
  const json& pose = report.pose.at("pose");
  rows.push_back(last_pose_row(section(report), message));
  rows.push_back({"Frames", fmt::format("{} in {}", pose.value("child_frame_id", ""),
                                        pose.value("frame_id", ""))});
  rows.push_back({"Position", position_words(message)});
  rows.push_back({"Rotation", rotation_words(message)});
  if (pose.contains("twist")) rows.push_back({"Speed", speed_words(pose["twist"])});
  const std::string weak = weak_words(message);
  rows.push_back({"Weak directions", weak.empty() ? "none" : weak,
                  weak.empty() ? Colour::none : Colour::warning});
}

StatusRow packets_row(const json& health) {
  const json packets = part(health, "packets");
  const std::uint64_t lost = count_in(packets, "lost"), received = count_in(packets, "received");
  const double all = static_cast<double>(lost + received);
  return {"Packets",
          fmt::format("{} received, {} lost ({:.2g} %), {} dropped by the kernel, {} malformed",
                      received, lost, all > 0.0 ? 100.0 * static_cast<double>(lost) / all : 0.0,
                      count_in(packets, "kernel_dropped"), count_in(packets, "malformed")),
          colour_of_count(count_in(packets, "kernel_dropped"))};
}

StatusRow scans_row(const json& health) {
  const json scans = part(health, "scans");
  return {"Scans",
          fmt::format("{} complete, {} partial, {} dropped, at most {} of {} waiting",
                      count_in(scans, "complete"), count_in(scans, "partial"),
                      count_in(scans, "dropped"), count_in(scans, "ring_high_water"),
                      count_in(scans, "ring_slots")),
          colour_of_count(count_in(scans, "dropped"))};
}

StatusRow quantiles_row(const char* label, const json& ms) {
  return {label, fmt::format("median {:.1f} ms, p99 {:.1f} ms, max {:.1f} ms", ms.value("p50", 0.0),
                             ms.value("p99", 0.0), ms.value("max", 0.0))};
}

StatusRow sent_row(const json& health) {
  const std::uint64_t errors = count_in(health, "send_errors");
  return {"Sent",
          fmt::format("{} poses, {} held back, {} send errors, subscribers: {}",
                      count_in(health, "poses_sent"), count_in(health, "poses_not_sent"), errors,
                      count_in(health, "clients")),
          colour_of_count(errors)};
}

StatusRow realtime_row(const json& health) {
  const json realtime = part(health, "realtime");
  const bool granted = realtime.value("as_configured", false);
  return {
      "Real time",
      fmt::format("{}: {} {} on CPU {}, {} MB locked, {} page faults",
                  granted ? "as configured" : "NOT as configured", realtime.value("policy", "?"),
                  count_in(realtime, "priority"), realtime.value("cpus", "?"),
                  count_in(realtime, "locked_kb") / 1024,
                  count_in(realtime, "worker_minor_faults") + count_in(realtime, "major_faults")),
      granted ? Colour::none : Colour::bad};
}

void add_map_row(const json& health, std::vector<StatusRow>& rows) {
  const std::uint64_t refused = count_in(health, "map_refused");
  if (refused == 0) return;
  rows.push_back({"Map", fmt::format("full: {} points left out", refused), Colour::bad});
}

}  // namespace

bool is_good(const StatusReport& report) {
  const json& health = section(report);
  return health.value("status", "") == "tracking" && complaints_text(health).empty();
}

std::vector<StatusRow> status_rows(const StatusReport& report) {
  const json& health = section(report);
  std::vector<StatusRow> rows;
  rows.push_back({"Daemon", daemon_words(report)});
  rows.push_back(status_row(health));
  rows.push_back(complaints_row(health));
  rows.push_back({"Session", report.health.value("session", "")});
  rows.push_back(sensor_row(health));
  add_tilt_row(health, rows);
  add_beams_row(health, rows);
  rows.push_back(rate_row(health));
  add_pose_rows(report, rows);
  rows.push_back(packets_row(health));
  rows.push_back(scans_row(health));
  add_map_row(health, rows);
  rows.push_back(quantiles_row("Latency", part(health, "latency_ms")));
  rows.push_back(quantiles_row("Processing", part(health, "processing_ms")));
  rows.push_back(sent_row(health));
  rows.push_back(realtime_row(health));
  rows.push_back({"Memory", fmt::format("{:.0f} MB in use",
                                        part(health, "realtime").value("resident_mb", 0.0))});
  return rows;
}

std::string to_text(const StatusRow& row, const Paint& paint) {
  return fmt::format("{:<16}: {}\n", printable(row.label), paint(row.colour, printable(row.text)));
}

std::string to_text(const StatusReport& report, const Paint& paint) {
  std::string text;
  for (const StatusRow& row : status_rows(report)) text += to_text(row, paint);
  return text;
}

std::string to_json(const StatusReport& report) {
  json out{{"good", is_good(report)},
           {"lilod", report.address},
           {"software", report.software},
           {"session", report.health.value("session", "")},
           {"health", section(report)}};
  if (!report.pose.is_null()) out["pose"] = report.pose.at("pose");
  return out.dump() + "\n";
}

}  // namespace lilo
