// SPDX-License-Identifier: BSD-3-Clause
#include "tools/info/info_report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <numbers>

namespace lilo {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr std::array kModels = {"unknown", "vlp16", "hdl64e", "vlp32c", "hdl32e", "vls128"};
constexpr std::array kReturnModes = {"strongest", "last", "dual"};
constexpr std::array kOrigins = {"none", "built_in", "file", "stored", "packets"};
constexpr std::array kClocks = {"host", "gps", "replay"};

template <typename Enum, std::size_t n>
const char* name_of(Enum value, const std::array<const char*, n>& names) {
  return names.at(static_cast<std::size_t>(value));
}

Json sensor_json(const RecordingInfo& info) {
  const SensorStatus& sensor = info.sensor;
  Json modes = Json::array();
  for (std::size_t k = 0; k < kReturnModes.size(); ++k) {
    if (info.return_modes[k]) modes.push_back(kReturnModes[k]);
  }
  const std::uint32_t ip = sensor.sensor_ipv4;
  return {{"model", name_of(sensor.model, kModels)},
          {"product_id", sensor.product_id},
          {"firmware", sensor.firmware},
          {"temperature_c", sensor.temperature_c},
          {"address",
           fmt::format("{}.{}.{}.{}", ip >> 24U, ip >> 16U & 0xFFU, ip >> 8U & 0xFFU, ip & 0xFFU)},
          {"return_modes", modes},
          {"rings", info.rings},
          {"packet_period_us", sensor.packet_period_us},
          {"blind_start_deg", sensor.blind_start_rad * kDegPerRad},
          {"blind_width_deg", sensor.blind_width_rad * kDegPerRad},
          {"rpm", {{"median", info.rpm}, {"min", info.rpm_min}, {"max", info.rpm_max}}}};
}

Json packets_json(const RecordingInfo& info) {
  const DriverCounts& driver = info.driver_counts;
  const SourceCounts& source = info.source_counts;
  return {{"data", driver.data_packets},
          {"position", driver.position_packets},
          {"lost", driver.packets_lost},
          {"lost_outside_scans", info.lost_outside_scans},
          {"late_for_scan", info.late_for_scan},
          {"blind", driver.packets_blind},
          {"duplicated", driver.packets_duplicated},
          {"reordered", driver.packets_reordered},
          {"waiting", driver.waiting_packets},
          {"malformed", driver.malformed_packets},
          {"other_sensor", driver.foreign_packets},
          {"wrong_sensor", driver.wrong_sensor_packets},
          {"not_udp", source.foreign},
          {"truncated", source.truncated},
          {"fragments", source.fragments}};
}

Json losses_json(const RecordingInfo& info) {
  Json losses = Json::array();
  for (const ScanLoss& loss : info.losses) {
    losses.push_back({{"scan", loss.scan},
                      {"after_s", loss.after_s},
                      {"start_ns", loss.start_ns},
                      {"packets", loss.packets},
                      {"hole_deg", loss.hole_width_rad * kDegPerRad}});
  }
  return losses;
}

}  // namespace

std::string to_json(const std::string& name, const RecordingInfo& info) {
  const DriverCounts& driver = info.driver_counts;
  Json clock;
  for (std::size_t k = 0; k < kClocks.size(); ++k) clock[kClocks[k]] = info.clock_scans[k];
  Json json;
  json["recording"] = name;
  json["link_type"] = info.link_type;
  json["sensor"] = sensor_json(info);
  json["calibration"] = {{"origin", name_of(info.sensor.calibration, kOrigins)},
                         {"progress", info.sensor.calibration_progress},
                         {"refused", info.sensor.calibrations_refused}};
  json["received"] = {{"first_ns", info.received.first_ns}, {"last_ns", info.received.last_ns}};
  json["clock_scans"] = clock;
  json["packets"] = packets_json(info);
  json["scans"] = {{"complete", driver.scans_complete},
                   {"partial", driver.scans_partial},
                   {"returns", info.returns},
                   {"start_ns", info.first_ns},
                   {"end_ns", info.last_ns}};
  json["sensor_restarts"] = driver.sensor_restarts;
  json["stalls"] = driver.stalls;
  json["losses"] = losses_json(info);
  json["failure"] = info.failure;
  return json.dump(2) + "\n";
}

}  // namespace lilo
