// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/calibration_xml.hpp"

#include "core/scan.hpp"
#include "drivers/packet_source.hpp"

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

namespace lilo {
namespace {

using boost::property_tree::ptree;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kMetresPerCm = 0.01;

struct Key {
  const char* name;
  double LaserCorrection::*value;
  double unit;
  bool required;
};
constexpr Key kKeys[] = {
    {"rotCorrection_", &LaserCorrection::rot_rad, kRadPerDeg, true},
    {"vertCorrection_", &LaserCorrection::vert_rad, kRadPerDeg, true},
    {"distCorrection_", &LaserCorrection::dist_m, kMetresPerCm, true},
    {"distCorrectionX_", &LaserCorrection::dist_x_m, kMetresPerCm, false},
    {"distCorrectionY_", &LaserCorrection::dist_y_m, kMetresPerCm, false},
    {"vertOffsetCorrection_", &LaserCorrection::vert_offset_m, kMetresPerCm, true},
    {"horizOffsetCorrection_", &LaserCorrection::horiz_offset_m, kMetresPerCm, true},
    {"focalDistance_", &LaserCorrection::focal_distance_m, kMetresPerCm, false},
    {"focalSlope_", &LaserCorrection::focal_slope, 1.0, false},
};

double number(const std::string& name, const ptree& parent, const Key& key, int laser) {
  const auto child = parent.get_child_optional(key.name);
  if (!child && !key.required) return 0.0;
  const auto value = child ? child->get_value_optional<double>() : boost::none;
  if (!value || !std::isfinite(*value))
    throw DriverError(name + ": laser " + std::to_string(laser) + ": " + key.name +
                      ": expected a number, found \"" + (child ? child->data() : "") + "\"");
  return *value * key.unit;
}

LaserCorrection read_laser(const std::string& name, const ptree& px, int id) {
  LaserCorrection laser;
  for (const Key& key : kKeys) laser.*key.value = number(name, px, key, id);
  laser.two_point = laser.dist_x_m != 0.0 || laser.dist_y_m != 0.0;
  return laser;
}

// <minIntensity_><count>64</count><item>30</item>...: by laser.
void read_intensities(const ptree& db, const char* list, int LaserCorrection::*limit,
                      Calibration& calibration) {
  const auto items = db.get_child_optional(list);
  if (!items) return;
  std::size_t i = 0;
  for (const auto& [tag, item] : *items) {
    if (tag != "item" || i == calibration.lasers.size()) continue;
    LaserCorrection& laser = calibration.lasers[i++];
    laser.*limit = item.get_value<int>(laser.*limit);
  }
}

// The parser calls itself for each element within an element: a file of nothing but opening tags
// would exhaust the stack. db.xml goes six deep.
bool nests_too_deep(const std::string& text) {
  constexpr int kMaxDepth = 32;
  int depth = 0;
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    const char next = text[i + 1];
    if (text[i] == '<' && next != '!' && next != '?')
      depth = std::max(0, depth + (next == '/' ? -1 : 1));
    if (text[i] == '/' && next == '>') depth = std::max(0, depth - 1);
    if (depth > kMaxDepth) return true;
  }
  return false;
}

ptree parse(const std::string& name, const std::string& text) {
  if (nests_too_deep(text))
    throw DriverError(name + ": expected a calibration in XML, found elements without end");
  std::istringstream in(text);
  ptree root;
  try {
    boost::property_tree::read_xml(in, root);
  } catch (const boost::property_tree::xml_parser_error& e) {
    throw DriverError(name + ":" + std::to_string(e.line()) +
                      ": expected a calibration in XML: " + e.message());
  }
  return root;
}

}  // namespace

Calibration read_calibration_xml(const std::string& name, const std::string& text) {
  const ptree root = parse(name, text);
  const auto db = root.get_child_optional("boost_serialization.DB");
  const auto points = db ? db->get_child_optional("points_") : boost::none;
  if (!points) throw DriverError(name + ": expected boost_serialization/DB/points_, found none");
  Calibration calibration;
  calibration.distance_step_m = db->get("distLSB_", 0.2) * kMetresPerCm;
  std::vector<bool> seen(kMaxRings);
  for (const auto& [tag, item] : *points) {
    const auto px = tag == "item" ? item.get_child_optional("px") : boost::none;
    if (!px) continue;
    const int id = px->get("id_", -1);
    if (id < 0 || id >= kMaxRings)
      throw DriverError(name + ": id_: expected 0 to 127, found \"" + px->get("id_", "") + "\"");
    const auto i = static_cast<std::size_t>(id);
    if (calibration.lasers.size() <= i) calibration.lasers.resize(i + 1);
    seen[i] = true;
    calibration.lasers[i] = read_laser(name, *px, id);
  }
  const auto count = static_cast<std::size_t>(std::count(seen.begin(), seen.end(), true));
  check_laser_count(name, count == calibration.lasers.size() ? count : 0);
  read_intensities(*db, "minIntensity_", &LaserCorrection::min_intensity, calibration);
  read_intensities(*db, "maxIntensity_", &LaserCorrection::max_intensity, calibration);
  return calibration;
}

}  // namespace lilo
