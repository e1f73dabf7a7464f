// SPDX-License-Identifier: BSD-3-Clause
// What `lilo info` says of a beams.yaml: in degrees, of the rings that saw the ground.
#include "tools/info/beams_text.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <numbers>
#include <string>

namespace lilo {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

/// Of three rings, the last of which saw no ground.
BeamEstimate three_rings() {
  BeamEstimate beams;
  beams.ring_count = 3;
  beams.elevation_rad = {0.1 * kRadPerDeg, -0.2 * kRadPerDeg};
  beams.elevation_sigma_rad = {0.01 * kRadPerDeg, 0.02 * kRadPerDeg, 0.06 * kRadPerDeg};
  beams.eccentricity_rad = {0.03 * kRadPerDeg, -0.04 * kRadPerDeg};
  beams.eccentricity_sigma_rad = 0.005 * kRadPerDeg;
  return beams;
}

bool has_line(const std::string& text, const std::string& line) {
  return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
}

TEST(BeamsText, GivesARowToEachRingThatSawTheGround) {
  const std::string text = to_text(three_rings());
  EXPECT_TRUE(has_line(text, "corrections that lilo found while driving, of 3 rings")) << text;
  EXPECT_TRUE(has_line(text, "elevation   0     +0.100 +- 0.010 deg")) << text;
  EXPECT_TRUE(has_line(text, "elevation   1     -0.200 +- 0.020 deg")) << text;
  EXPECT_EQ(text.find("elevation   2"), std::string::npos) << text;
  EXPECT_TRUE(has_line(text, "azimuth, cosine   +0.030 +- 0.005 deg")) << text;
  EXPECT_TRUE(has_line(text, "azimuth, sine     -0.040 +- 0.005 deg")) << text;
}

TEST(BeamsText, NamesTheCommonElevationWhereThereIsOne) {
  BeamEstimate beams = three_rings();
  EXPECT_EQ(to_text(beams).find("elevation, common"), std::string::npos);
  EXPECT_FALSE(nlohmann::json::parse(to_json(beams)).contains("common_elevation_deg"));
  beams.common_elevation_rad = 0.05 * kRadPerDeg;
  beams.common_elevation_sigma_rad = 0.007 * kRadPerDeg;
  EXPECT_TRUE(has_line(to_text(beams), "elevation, common +0.050 +- 0.007 deg")) << to_text(beams);
  const nlohmann::json json = nlohmann::json::parse(to_json(beams));
  EXPECT_NEAR(json["common_elevation_deg"], 0.05, 1e-12);
  EXPECT_NEAR(json["common_elevation_sigma_deg"], 0.007, 1e-12);
}

TEST(BeamsText, JsonHasEveryRingInDegrees) {
  const nlohmann::json json = nlohmann::json::parse(to_json(three_rings()));
  EXPECT_EQ(json["rings"], 3);
  ASSERT_EQ(json["elevation_deg"].size(), 3U);
  EXPECT_NEAR(json["elevation_deg"][1], -0.2, 1e-12);
  EXPECT_EQ(json["elevation_deg"][2], 0.0);
  EXPECT_NEAR(json["elevation_sigma_deg"][2], 0.06, 1e-12);
  EXPECT_NEAR(json["azimuth_deg"][1], -0.04, 1e-12);
  EXPECT_NEAR(json["azimuth_sigma_deg"], 0.005, 1e-12);
}

}  // namespace
}  // namespace lilo
