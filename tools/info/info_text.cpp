// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/sensor_table.hpp"
#include "tools/info/info_report.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lilo {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::size_t kShownLosses = 8;

std::string line(const char* label, const std::string& text) {
  return fmt::format("{:<13}{}\n", label, text);
}

/// Appends "NUMBER what" unless the number is 0.
void add_count(std::string& text, std::uint64_t number, const char* what) {
  if (number > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", number, what);
}

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

std::string utc(std::int64_t ns) {
  const std::int64_t whole = ns / kSecondNs - (ns % kSecondNs < 0 ? 1 : 0);
  return fmt::format("{:%Y-%m-%d %H:%M:%S}.{:03}", fmt::gmtime(static_cast<std::time_t>(whole)),
                     (ns - whole * kSecondNs) / 1'000'000);
}

std::string plural(std::uint64_t number, const char* what) {
  return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
}

/// S2 and S3 differ in the time from one shot of all lasers to the next (48 and 57.6 us), which
/// the packet period tells: 3 or 6 shots a packet.
std::string hdl64e_title(const SensorStatus& sensor) {
  std::string text = "HDL-64E";
  for (const double shots : {3.0, 6.0}) {
    const double shot_us = sensor.packet_period_us / shots;
    if (std::abs(shot_us - 48.0) < 2.0) text += ", S2 timing";
    if (std::abs(shot_us - 57.6) < 2.0) text += ", S3 timing";
  }
  if (sensor.firmware > 0)
    text += fmt::format(", firmware {}.{:02}", sensor.firmware >> 4U, sensor.firmware & 0xFU);
  if (sensor.temperature_c > 0) text += fmt::format(", {} C", sensor.temperature_c);
  return text;
}

std::string sensor_text(const RecordingInfo& info) {
  const SensorStatus& sensor = info.sensor;
  const bool refused = sensor.refused.packets > 0;
  if (sensor.model == SensorModel::automatic)
    return refused ? "packets of a sensor that is not known here: " + sensor.refused.name()
                   : "unknown: no packet of a rotating Velodyne";
  const SensorTable* table = find_product(sensor.product_id);
  std::string text = table == nullptr ? hdl64e_title(sensor) : table->name;
  constexpr std::array kModes = {"strongest", "last", "dual"};
  std::string modes;
  for (std::size_t k = 0; k < kModes.size(); ++k) {
    if (info.return_modes[k]) modes += (modes.empty() ? "" : " and ") + std::string(kModes[k]);
  }
  return text + ", " + modes + " return";
}

/// libpcap's names say little to most.
std::string link_text(const std::string& name) {
  if (name == "EN10MB") return "Ethernet";
  if (name == "LINUX_SLL") return "Linux cooked v1";
  if (name == "LINUX_SLL2") return "Linux cooked v2";
  if (name == "RAW" || name == "DLT_RAW") return "raw IP";
  return name;
}

std::string captured_text(const RecordingInfo& info) {
  const ReceivedSpan& span = info.received;
  std::string text =
      fmt::format("{} UTC, {:.1f} s", utc(span.first_ns), seconds(span.last_ns - span.first_ns));
  if (!info.link_type.empty()) text += ", frames of " + link_text(info.link_type);
  const std::uint32_t ip = info.sensor.sensor_ipv4;
  if (ip == 0) return text;
  return text + fmt::format(", from {}.{}.{}.{}", ip >> 24U, ip >> 16U & 0xFFU, ip >> 8U & 0xFFU,
                            ip & 0xFFU);
}

std::string rotation_text(const RecordingInfo& info) {
  const bool steady = info.rpm_max - info.rpm_min < 0.02 * info.rpm;
  if (steady) return fmt::format("{:.0f} rpm", info.rpm);
  return fmt::format("{:.0f} to {:.0f} rpm, mostly {:.0f}", info.rpm_min, info.rpm_max, info.rpm);
}

/// Clockwise, as the sensor and its web page count.
std::string blind_text(const RecordingInfo& info) {
  const SensorStatus& sensor = info.sensor;
  const double from = std::fmod(360.0 - sensor.blind_start_rad * kDegPerRad, 360.0);
  std::string text = fmt::format("sends nothing for {:.0f} degrees from {:.0f} on, clockwise",
                                 sensor.blind_width_rad * kDegPerRad, from);
  if (info.driver_counts.packets_blind > 0)
    text += fmt::format("; {} counted as lost before that was known",
                        plural(info.driver_counts.packets_blind, "packet"));
  return text;
}

std::string clock_text(const RecordingInfo& info) {
  const auto [host, gps, replay] = info.clock_scans;
  if (host > 0 && gps > 0)
    return fmt::format("GPS in {}, the capturing computer's in {}", plural(gps, "scan"),
                       plural(host, "scan"));
  if (gps > 0) return "GPS: stamps are UTC";
  if (host > 0) return "no GPS: stamps are placed by the capturing computer's clock";
  return replay > 0 ? "times of the data set" : "not known without a scan";
}

std::string calibration_text(const SensorStatus& sensor) {
  std::string text;
  switch (sensor.calibration) {
    case CalibrationOrigin::none:
      text = fmt::format(
          "none: {:.0f} % of a table are in the packets; name a file in sensor.calibration_file",
          std::floor(100.0 * sensor.calibration_progress));
      break;
    case CalibrationOrigin::built_in:
      text = "built in, the same for every unit";
      break;
    case CalibrationOrigin::file:
      text = "from the configured file";
      break;
    case CalibrationOrigin::stored:
      text = "stored by an earlier run";
      break;
    case CalibrationOrigin::packets:
      text = "this unit's, from the packets";
      break;
  }
  if (sensor.calibrations_refused > 0)
    text += fmt::format("; {} refused", plural(sensor.calibrations_refused, "table"));
  return text;
}

std::string packets_text(const RecordingInfo& info) {
  const DriverCounts& driver = info.driver_counts;
  std::string text =
      fmt::format("{} data, {} position", driver.data_packets, driver.position_packets);
  add_count(text, driver.waiting_packets, "before timing and calibration were known");
  return text;
}

std::string trouble_text(const DriverCounts& driver) {
  const double sent = static_cast<double>(driver.data_packets + driver.packets_lost);
  std::string text = "0 lost";
  if (driver.packets_lost > 0) {
    text = fmt::format("{} lost ({:.2f} %)", driver.packets_lost,
                       100.0 * static_cast<double>(driver.packets_lost) / sent);
  }
  add_count(text, driver.packets_duplicated, "duplicated");
  add_count(text, driver.packets_reordered, "reordered");
  return text;
}

std::string left_out_text(const RecordingInfo& info) {
  std::string text;
  add_count(text, info.driver_counts.malformed_packets, "malformed");
  if (const RefusedSensor& refused = info.sensor.refused; refused.packets > 0)
    add_count(text, refused.packets, ("of another model, last a " + refused.name()).c_str());
  add_count(text, info.driver_counts.foreign_packets, "of another sensor");
  add_count(text, info.source_counts.foreign, "not UDP");
  add_count(text, info.source_counts.truncated, "truncated");
  add_count(text, info.source_counts.fragments, "IP fragments");
  return text;
}

std::string scans_text(const RecordingInfo& info) {
  const DriverCounts& driver = info.driver_counts;
  std::string text =
      fmt::format("{} complete, {} partial", driver.scans_complete, driver.scans_partial);
  if (info.scans > 0) {
    text += fmt::format("; {:.0f} returns each on {} rings",
                        static_cast<double>(info.returns) / static_cast<double>(info.scans),
                        info.rings);
  }
  return text;
}

/// The scans that lost most, in the order of time.
std::string losses_text(const RecordingInfo& info) {
  if (info.losses.empty() && info.lost_outside_scans == 0) return {};
  std::vector<ScanLoss> shown = info.losses;
  if (shown.size() > kShownLosses) {
    std::nth_element(shown.begin(), shown.begin() + kShownLosses, shown.end(),
                     [](const ScanLoss& a, const ScanLoss& b) { return a.packets > b.packets; });
    shown.resize(kShownLosses);
    std::sort(shown.begin(), shown.end(),
              [](const ScanLoss& a, const ScanLoss& b) { return a.scan < b.scan; });
  }
  std::string where = fmt::format("in {} of {}", info.losses.size(), plural(info.scans, "scan"));
  if (info.lost_outside_scans > 0)
    where += fmt::format(", {} outside of scans", info.lost_outside_scans);
  if (info.late_for_scan > 0) where += fmt::format(", {} came too late", info.late_for_scan);
  if (shown.size() < info.losses.size()) where += "; most in these (all: --json)";
  std::string text = line("losses", where);
  if (!shown.empty()) text += "             after s    scan  packets  largest hole\n";
  for (const ScanLoss& loss : shown) {
    text += fmt::format("         {:11.1f}{:8}{:9}{:9.1f} deg\n", loss.after_s, loss.scan,
                        loss.packets, loss.hole_width_rad * kDegPerRad);
  }
  return text;
}

std::string data_set_text(const RecordingInfo& info) {
  const std::string points = info.motion_compensated ? "motion-compensated by its authors"
                                                     : "as measured, with times by azimuth";
  return line("holds", "scans of a data set, " + points) +
         line("recorded", fmt::format("{:.1f} s", seconds(info.last_ns - info.first_ns))) +
         line("scans", scans_text(info));
}

}  // namespace

std::string to_text(const std::string& name, const RecordingInfo& info) {
  std::string text = line("recording", name == "-" ? "standard input" : name);
  if (info.clock_scans[static_cast<std::size_t>(ClockSource::replay)] > 0)
    return text + data_set_text(info);
  const DriverCounts& driver = info.driver_counts;
  text += line("sensor", sensor_text(info));
  if (info.received.first_ns != 0) text += line("captured", captured_text(info));
  if (driver.data_packets > 0) {
    if (info.rpm > 0.0) text += line("rotation", rotation_text(info));
    if (info.sensor.blind_width_rad > 0.0) text += line("blind sector", blind_text(info));
    text += line("clock", clock_text(info));
    if (info.scans > 0) text += line("first scan", utc(info.first_ns) + " UTC by that clock");
    text += line("calibration", calibration_text(info.sensor));
    text += line("scans", scans_text(info));
  }
  text += line("packets", packets_text(info)) + line("", trouble_text(driver));
  const std::string left_out = left_out_text(info);
  text += line("left out", left_out.empty() ? "nothing" : left_out);
  std::string events;
  add_count(events, driver.sensor_restarts, "jumps of the sensor's clock (restarts)");
  add_count(events, driver.stalls, "stalls of the motor");
  if (!events.empty()) text += line("events", events);
  return text + losses_text(info);
}

}  // namespace lilo
