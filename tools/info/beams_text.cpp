// SPDX-License-Identifier: BSD-3-Clause
#include "tools/info/beams_text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <numbers>

namespace lilo {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

std::string row(const std::string& name, double correction_rad, double sigma_rad) {
  return fmt::format("{:<18}{:+.3f} +- {:.3f} deg\n", name, correction_rad * kDegPerRad,
                     sigma_rad * kDegPerRad);
}

}  // namespace

std::string to_json(const BeamEstimate& beams) {
  nlohmann::ordered_json json;
  json["rings"] = beams.ring_count;
  for (int ring = 0; ring < beams.ring_count; ++ring) {
    const auto k = static_cast<std::size_t>(ring);
    json["elevation_deg"].push_back(beams.elevation_rad[k] * kDegPerRad);
    json["elevation_sigma_deg"].push_back(beams.elevation_sigma_rad[k] * kDegPerRad);
  }
  for (const double rad : beams.eccentricity_rad) json["azimuth_deg"].push_back(rad * kDegPerRad);
  json["azimuth_sigma_deg"] = beams.eccentricity_sigma_rad * kDegPerRad;
  if (beams.common_elevation_sigma_rad > 0.0) {
    json["common_elevation_deg"] = beams.common_elevation_rad * kDegPerRad;
    json["common_elevation_sigma_deg"] = beams.common_elevation_sigma_rad * kDegPerRad;
  }
  return json.dump(2) + "\n";
}

bool is_beams_file(const std::string& path) { return path.ends_with(".yaml"); }

std::string to_text(const BeamEstimate& beams) {
  std::string text =
      fmt::format("corrections that lilo found while driving, of {} rings\n", beams.ring_count);
  for (int ring = 0; ring < beams.ring_count; ++ring) {
    const auto k = static_cast<std::size_t>(ring);
    if (beams.elevation_rad[k] == 0.0) continue;
    text += row(fmt::format("elevation {:>3}", ring), beams.elevation_rad[k],
                beams.elevation_sigma_rad[k]);
  }
  if (beams.common_elevation_rad != 0.0) {
    text += row("elevation, common", beams.common_elevation_rad, beams.common_elevation_sigma_rad);
  }
  text += row("azimuth, cosine", beams.eccentricity_rad[0], beams.eccentricity_sigma_rad);
  text += row("azimuth, sine", beams.eccentricity_rad[1], beams.eccentricity_sigma_rad);
  return text +
         "Rings are counted from the lowest; those without a row saw no ground. The common "
         "elevation\n"
         "is that of a ring 5 deg below the horizon, and of others in inverse proportion.\n";
}

}  // namespace lilo
