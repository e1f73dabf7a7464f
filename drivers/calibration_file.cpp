// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/calibration.hpp"
#include "drivers/calibration_xml.hpp"
#include "drivers/packet_source.hpp"
#include "drivers/regular_file.hpp"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace lilo {
namespace {

struct Key {
  const char* name;
  double LaserCorrection::*value;
};
constexpr Key kKeys[] = {
    {"rot_correction", &LaserCorrection::rot_rad},
    {"vert_correction", &LaserCorrection::vert_rad},
    {"dist_correction", &LaserCorrection::dist_m},
    {"dist_correction_x", &LaserCorrection::dist_x_m},
    {"dist_correction_y", &LaserCorrection::dist_y_m},
    {"vert_offset_correction", &LaserCorrection::vert_offset_m},
    {"horiz_offset_correction", &LaserCorrection::horiz_offset_m},
    {"focal_distance", &LaserCorrection::focal_distance_m},
    {"focal_slope", &LaserCorrection::focal_slope},
};

[[noreturn]] void refuse(const std::string& path, const YAML::Mark& mark, const std::string& what) {
  throw DriverError(path + ":" + std::to_string(mark.line + 1) + ": " + what);
}

template <typename T>
T read(const std::string& path, const YAML::Node& map, const char* key, T absent,
       const char* expected) {
  const YAML::Node node = map[key];
  if (!node) return absent;
  T value{};
  if (!node.IsScalar() || !YAML::convert<T>::decode(node, value))
    refuse(path, node.Mark(),
           std::string(key) + ": expected " + expected + ", found " +
               (node.IsScalar() ? "\"" + node.Scalar() + "\"" : "a list"));
  return value;
}

LaserCorrection read_laser(const std::string& path, const YAML::Node& node) {
  LaserCorrection laser;
  for (const Key& key : kKeys) {
    laser.*key.value = read(path, node, key.name, 0.0, "a number");
    if (!std::isfinite(laser.*key.value))
      refuse(path, node[key.name].Mark(), std::string(key.name) + ": expected a finite number");
  }
  laser.min_intensity = read(path, node, "min_intensity", 0, "a whole number");
  laser.max_intensity = read(path, node, "max_intensity", 255, "a whole number");
  // Tables with the flag set and zeros in both places exist: those were never measured near by.
  const bool measured = laser.dist_x_m != 0.0 || laser.dist_y_m != 0.0;
  laser.two_point =
      measured && read(path, node, "two_pt_correction_available", measured, "true or false");
  return laser;
}

Calibration read_yaml(const std::string& path, const std::string& text) {
  const YAML::Node root = YAML::Load(text);
  if (!root.IsMap() || !root["lasers"].IsSequence())
    throw DriverError(path + ": expected a list \"lasers\", found none");
  Calibration calibration;
  calibration.distance_step_m =
      read(path, root, "distance_resolution", 0.002, "a number of metres");
  const std::size_t count = root["lasers"].size();
  check_laser_count(path, count);
  calibration.lasers.resize(count);
  std::vector<bool> seen(count);
  for (const YAML::Node& node : root["lasers"]) {
    if (!node.IsMap()) refuse(path, node.Mark(), "lasers: expected a map per laser");
    const int id = read(path, node, "laser_id", -1, "a whole number");
    if (id < 0 || id >= static_cast<int>(count))
      refuse(
          path, node.Mark(),
          "laser_id: expected 0 to " + std::to_string(count - 1) + ", found " + std::to_string(id));
    const auto i = static_cast<std::size_t>(id);
    if (seen[i]) refuse(path, node.Mark(), "laser_id: " + std::to_string(id) + " stands twice");
    seen[i] = true;
    calibration.lasers[i] = read_laser(path, node);
  }
  return calibration;
}

}  // namespace

void check_laser_count(const std::string& name, std::size_t count) {
  if (count != 16 && count != 32 && count != 64 && count != 128)
    throw DriverError(name + ": expected 16, 32, 64 or 128 lasers, found " + std::to_string(count));
}

Calibration parse_calibration(const std::string& name, const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (begin == std::string::npos)
    throw DriverError(name + ": expected a calibration (db.xml or YAML), found an empty file");
  Calibration calibration;
  try {
    calibration = text[begin] == '<' ? read_calibration_xml(name, text) : read_yaml(name, text);
  } catch (const YAML::Exception& e) {
    throw DriverError(name + ":" + std::to_string(e.mark.line + 1) +
                      ": expected a calibration in YAML: " + e.msg);
  }
  if (const std::string problem = implausible(calibration); !problem.empty())
    throw DriverError(name + ": no sensor has this calibration: " + problem);
  return calibration;
}

Calibration load_calibration(const std::string& path) {
  return parse_calibration(path, read_regular_file(path, "calibration"));
}

std::string stored_calibration_path(const std::string& state_directory) {
  return state_directory + "/hdl64e_calibration.yaml";
}

std::string calibration_yaml(const Calibration& calibration) {
  YAML::Emitter out;
  out.SetDoublePrecision(12);
  out << YAML::BeginMap << YAML::Key << "lasers" << YAML::Value << YAML::BeginSeq;
  for (std::size_t i = 0; i < calibration.lasers.size(); ++i) {
    const LaserCorrection& laser = calibration.lasers[i];
    out << YAML::BeginMap << YAML::Key << "laser_id" << YAML::Value << i;
    for (const Key& key : kKeys) out << YAML::Key << key.name << YAML::Value << laser.*key.value;
    out << YAML::Key << "min_intensity" << YAML::Value << laser.min_intensity;
    out << YAML::Key << "max_intensity" << YAML::Value << laser.max_intensity;
    out << YAML::Key << "two_pt_correction_available" << YAML::Value << laser.two_point;
    out << YAML::EndMap;
  }
  out << YAML::EndSeq << YAML::Key << "num_lasers" << YAML::Value << calibration.lasers.size();
  out << YAML::Key << "distance_resolution" << YAML::Value << calibration.distance_step_m;
  out << YAML::EndMap;
  return std::string(out.c_str()) + '\n';
}

bool store_calibration(const std::string& path, const Calibration& calibration) {
  const std::string temporary = path + ".new";
  {
    std::ofstream file(temporary, std::ios::trunc);
    file << calibration_yaml(calibration);
    if (!file.flush()) return false;
  }
  std::error_code error;
  std::filesystem::rename(temporary, path, error);
  return !error;
}

}  // namespace lilo
