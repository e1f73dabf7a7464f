// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/beam_file.hpp"

#include "drivers/packet_source.hpp"
#include "drivers/regular_file.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace lilo {
namespace {

constexpr double kRadPerMrad = 1e-3;
constexpr double kMost_mrad = 17.5;  // 1 deg

[[noreturn]] void refuse(const std::string& path, const YAML::Node& at, const std::string& what) {
  throw DriverError(path + ":" + std::to_string(at.Mark().line + 1) + ": " + what);
}

/// Refused at the line of `map`, which exists in any case.
double angle_rad(const std::string& path, const YAML::Node& map, const std::string& key,
                 const YAML::Node& number) {
  double mrad = 0.0;
  if (!number.IsDefined() || !YAML::convert<double>::decode(number, mrad) ||
      !(std::abs(mrad) <= kMost_mrad))
    refuse(path, map, key + ": expected milliradians, at most 17.5");
  return mrad * kRadPerMrad;
}

void read_angles(const std::string& path, const YAML::Node& root, const std::string& key,
                 std::span<double> angles_rad) {
  const YAML::Node list = root[key];
  if (!list || !list.IsSequence() || list.size() != angles_rad.size())
    refuse(path, root, key + ": expected a list of " + std::to_string(angles_rad.size()));
  for (std::size_t k = 0; k < angles_rad.size(); ++k)
    angles_rad[k] = angle_rad(path, list, key, list[k]);
}

/// Files of earlier versions do not have it.
void read_common(const std::string& path, const YAML::Node& root, const std::string& key,
                 double& common_rad, double& sigma_rad) {
  const YAML::Node common = root[key + "_mrad"];
  if (!common) return;
  common_rad = angle_rad(path, root, key + "_mrad", common);
  const std::string sigma_key = key + "_sigma_mrad";
  sigma_rad = angle_rad(path, root, sigma_key, root[sigma_key]);
  if (!(sigma_rad > 0.0)) refuse(path, root, sigma_key + ": expected more than 0");
}

BeamEstimate read_yaml(const std::string& path, const YAML::Node& root) {
  BeamEstimate beams;
  const YAML::Node rings = root.IsMap() ? root["rings"] : YAML::Node();
  if (!rings || !YAML::convert<int>::decode(rings, beams.ring_count) || beams.ring_count < 1 ||
      beams.ring_count > kMaxRings)
    refuse(path, root, "expected lilod's beams, with rings from 1 to " + std::to_string(kMaxRings));
  const auto count = static_cast<std::size_t>(beams.ring_count);
  read_angles(path, root, "elevation_mrad", std::span(beams.elevation_rad).first(count));
  read_angles(path, root, "elevation_sigma_mrad",
              std::span(beams.elevation_sigma_rad).first(count));
  read_angles(path, root, "eccentricity_mrad", beams.eccentricity_rad);
  beams.eccentricity_sigma_rad =
      angle_rad(path, root, "eccentricity_sigma_mrad", root["eccentricity_sigma_mrad"]);
  read_common(path, root, "common_elevation", beams.common_elevation_rad,
              beams.common_elevation_sigma_rad);
  read_common(path, root, "common_by_path", beams.common_by_path_rad,
              beams.common_by_path_sigma_rad);
  const std::span sigmas_rad = std::span(beams.elevation_sigma_rad).first(count);
  const bool are_known =
      std::all_of(sigmas_rad.begin(), sigmas_rad.end(), [](double s) { return s > 0.0; });
  if (!are_known || !(beams.eccentricity_sigma_rad > 0.0))
    refuse(path, root, "elevation_sigma_mrad, eccentricity_sigma_mrad: expected more than 0");
  return beams;
}

void write_angles(YAML::Emitter& out, const char* key, std::span<const double> angles_rad) {
  out << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (const double rad : angles_rad) out << rad / kRadPerMrad;
  out << YAML::EndSeq;
}

void write_common(YAML::Emitter& out, const std::string& key, double common_rad, double sigma_rad) {
  if (!(sigma_rad > 0.0)) return;
  out << YAML::Key << key + "_mrad" << YAML::Value << common_rad / kRadPerMrad;
  out << YAML::Key << key + "_sigma_mrad" << YAML::Value << sigma_rad / kRadPerMrad;
}

}  // namespace

std::string kept_beams_path(const std::string& state_directory) {
  return state_directory + "/beams.yaml";
}

std::string beams_yaml(const BeamEstimate& beams) {
  const auto count = static_cast<std::size_t>(beams.ring_count);
  YAML::Emitter out;
  out.SetDoublePrecision(12);
  out << YAML::Comment(
             "Errors of the sensor's beams, which lilo found while driving: what it adds to the\n"
             "elevation of each ring, from the lowest, and to an azimuth: the first number times\n"
             "its cosine and the second times its sine. The common elevation is added to all\n"
             "rings that see the ground: that of a ring 5 degrees below the horizon, and of "
             "others\n"
             "in inverse proportion. What the path alone tells of it (by_path) is not added.\n"
             "Delete this file after a change of the sensor.")
      << YAML::Newline << YAML::BeginMap;
  out << YAML::Key << "rings" << YAML::Value << beams.ring_count;
  write_angles(out, "elevation_mrad", std::span(beams.elevation_rad).first(count));
  write_angles(out, "elevation_sigma_mrad", std::span(beams.elevation_sigma_rad).first(count));
  write_angles(out, "eccentricity_mrad", beams.eccentricity_rad);
  out << YAML::Key << "eccentricity_sigma_mrad" << YAML::Value
      << beams.eccentricity_sigma_rad / kRadPerMrad;
  write_common(out, "common_elevation", beams.common_elevation_rad,
               beams.common_elevation_sigma_rad);
  write_common(out, "common_by_path", beams.common_by_path_rad, beams.common_by_path_sigma_rad);
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

BeamEstimate read_beams(const std::string& path) {
  try {
    return read_yaml(path, YAML::Load(read_regular_file(path, "beams")));
  } catch (const YAML::Exception& e) {
    throw DriverError(path + ":" + std::to_string(e.mark.line + 1) + ": expected YAML: " + e.msg);
  }
}

}  // namespace lilo
