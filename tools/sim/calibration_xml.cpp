// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/calibration.hpp"
#include "tools/sim/text_out.hpp"

#include <fmt/format.h>

#include <numbers>

namespace lilo::sim {
namespace {

template <typename Value>
std::string list(const char* name, const std::vector<LaserCorrection>& lasers, Value&& value) {
  std::string text = fmt::format("<{}><count>{}</count>", name, lasers.size());
  for (const LaserCorrection& laser : lasers) text += fmt::format("<item>{}</item>", value(laser));
  return text + fmt::format("</{}>\n", name);
}

}  // namespace

void write_calibration_xml(const std::string& path, const std::vector<LaserCorrection>& lasers) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\" ?>\n"
      "<!DOCTYPE boost_serialization>\n"
      "<boost_serialization signature=\"serialization::archive\" version=\"4\">\n"
      "<DB class_id=\"0\" tracking_level=\"1\" version=\"0\" object_id=\"_0\">\n"
      "<distLSB_>0.2</distLSB_>\n";
  text += list("enabled_", lasers, [](const LaserCorrection&) { return 1; });
  text += list("minIntensity_", lasers, [](const LaserCorrection& c) { return c.min_intensity; });
  text += list("maxIntensity_", lasers, [](const LaserCorrection& c) { return c.max_intensity; });
  text += fmt::format("<points_><count>{}</count><item_version>1</item_version>\n", lasers.size());
  for (std::size_t id = 0; id < lasers.size(); ++id) {
    const LaserCorrection& c = lasers[id];
    // Lengths in centimetres, angles in degrees.
    text += fmt::format(
        "<item><px><id_>{}</id_><rotCorrection_>{:.6g}</rotCorrection_>"
        "<vertCorrection_>{:.6g}</vertCorrection_><distCorrection_>{:.6g}</distCorrection_>"
        "<distCorrectionX_>{:.6g}</distCorrectionX_><distCorrectionY_>{:.6g}</distCorrectionY_>"
        "<vertOffsetCorrection_>{:.6g}</vertOffsetCorrection_>"
        "<horizOffsetCorrection_>{:.6g}</horizOffsetCorrection_>"
        "<focalDistance_>{:.6g}</focalDistance_><focalSlope_>{:.6g}</focalSlope_></px></item>\n",
        id, c.rotation_rad * kDegrees, c.elevation_rad * kDegrees, 100.0 * c.distance_m,
        100.0 * c.distance_x_m, 100.0 * c.distance_y_m, 100.0 * c.vertical_offset_m,
        100.0 * c.horizontal_offset_m, 100.0 * c.focal_distance_m, c.focal_slope);
  }
  write_text(path, text + "</points_></DB></boost_serialization>\n");
}

}  // namespace lilo::sim
