// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/meta_writer.hpp"

#include "tools/sim/text_out.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>

namespace lilo::sim {

namespace {
constexpr const char* kMadeBy = "lilo sim";
}  // namespace

std::string sensor_name(Sensor sensor) {
  switch (sensor) {
    case Sensor::vlp16:
      return "vlp16";
    case Sensor::vlp16_hires:
      return "vlp16_hires";
    case Sensor::hdl64_s2:
      return "hdl64_s2";
    case Sensor::hdl64_s3:
      return "hdl64_s3";
    case Sensor::vlp32c:
      return "vlp32c";
    case Sensor::hdl32e:
      return "hdl32e";
    case Sensor::vls128:
      return "vls128";
  }
  return "unknown";
}

bool is_made_by_sim(const std::string& folder) {
  std::ifstream file(folder + "/meta.json");
  const auto meta = nlohmann::json::parse(file, nullptr, false);
  return meta.is_object() && meta.value("made_by", nlohmann::json()) == kMadeBy;
}

void write_meta(const std::string& folder, const SimOptions& options, const SimSummary& summary,
                const PathSummary& path, const Scene& scene, const Rotor& rotor) {
  const auto rounded = [](double v) { return std::round(v * 1e4) / 1e4; };
  nlohmann::ordered_json meta;
  meta["made_by"] = kMadeBy;
  meta["sensor"] = sensor_name(options.sensor.sensor);
  meta["world"] = options.world;
  meta["seed"] = options.seed;
  meta["rpm"] = options.sensor.rpm;
  meta["duration_s"] = options.motion.duration_s;
  const std::int64_t start_us = options.start_utc_ns / 1000, hour_us = start_us % 3'600'000'000;
  meta["unix_start"] = static_cast<double>(start_us) / 1e6;
  meta["hour_offset_s"] = static_cast<double>(hour_us) / 1e6;
  meta["start_azimuth_deg"] = rounded(rotor.azimuth_deg(0.0));
  meta["revolutions"] = summary.revolutions;
  meta["packets_sent"] = summary.packets_sent;
  meta["packets_lost"] = summary.faults.lost;
  meta["duplicates"] = summary.faults.duplicates;
  meta["reordered"] = summary.faults.reordered;
  meta["garbage"] = summary.faults.garbage;
  meta["position_packets"] = summary.position_packets;
  meta["path_length_m"] = rounded(path.length_m);
  meta["max_speed_mps"] = rounded(path.max_speed_mps);
  meta["max_horizontal_accel_mps2"] = rounded(path.max_accel_mps2);
  meta["max_turn_rate_dps"] = rounded(path.max_turn_rate_dps);
  meta["end_minus_start_m"] = {rounded(path.end_minus_start_m.x()),
                               rounded(path.end_minus_start_m.y()),
                               rounded(path.end_minus_start_m.z())};
  meta["range_sigma_m"] = options.sensor.range_sigma_m;
  meta["dropout"] = options.sensor.dropout;
  meta["max_range_m"] = options.sensor.max_range_m;
  meta["dual"] = options.sensor.returns == ReturnMode::dual;
  meta["two_point"] = options.sensor.two_point;
  meta["hdl_azimuth"] = options.sensor.turning_block ? "firing" : "block";
  meta["robot_boxes_m"] = options.sensor.robot;
  meta["tilt_deg"] = options.motion.tilt_deg;
  meta["roll_deg"] = options.motion.roll_deg;
  meta["shake_hz"] = options.motion.shake_hz;
  meta["shake_dps"] = options.motion.shake_dps;
  meta["gps"] = options.sensor.gps;
  meta["movers"] = scene.mover_count();
  meta["triangles"] = scene.triangle_count();
  write_text(folder + "/meta.json", meta.dump(2) + "\n");
}

}  // namespace lilo::sim
