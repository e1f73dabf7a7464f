// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/calibration.hpp"
#include "drivers/packet_source.hpp"
#include "tests/drivers/capture_file.hpp"
#include "tests/drivers/data_dir.hpp"
#include "tests/drivers/same_calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <unistd.h>

namespace lilo {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

std::string text_of(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string refusal(const std::string& text) {
  try {
    load_calibration(test::write_file("calibration", text));
  } catch (const DriverError& e) {
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
    return e.what();
  }
  return "taken";
}

std::string good_yaml() {
  const std::string path = testing::TempDir() + "/good" + std::to_string(getpid()) + ".yaml";
  EXPECT_TRUE(store_calibration(path, test::sample_calibration(true)));
  return text_of(path);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(CalibrationFile, WhatIsStoredIsRead) {
  const std::string path = testing::TempDir() + "/round.yaml";
  const Calibration stored = test::sample_calibration(true);
  ASSERT_TRUE(store_calibration(path, stored));
  const Calibration read = load_calibration(path);
  for (std::size_t i = 0; i < 64; ++i) {
    EXPECT_NEAR(read.lasers[i].rot_rad, stored.lasers[i].rot_rad, 1e-11);
    EXPECT_NEAR(read.lasers[i].dist_y_m, stored.lasers[i].dist_y_m, 1e-11);
    EXPECT_EQ(read.lasers[i].two_point, stored.lasers[i].two_point);
    EXPECT_EQ(read.lasers[i].min_intensity, stored.lasers[i].min_intensity);
  }
  EXPECT_FALSE(store_calibration("/nowhere/at/all.yaml", stored));
}

TEST(CalibrationFile, RealTablesAreRead) {
  LILO_NEED_DATA("calib");
  for (const char* name : {"64e_s2.1-sztaki.yaml", "64e_s3-xiesc.yaml", "64e_utexas.yaml",
                           "hdl64e_s3_unit1090_calib.yaml"}) {
    const Calibration c = load_calibration(test::data_path(std::string("calib/") + name));
    // Upper block above the lower one (velodyne manual; settled by the unit 1090's own table).
    EXPECT_GT(c.lasers[0].vert_rad, -10.0 * kDeg) << name;
    EXPECT_LT(c.lasers[63].vert_rad, -8.0 * kDeg) << name;
  }
  const auto s2 = load_calibration(test::data_path("calib/64e_s2.1-sztaki.yaml"));
  EXPECT_NEAR(s2.lasers[0].dist_x_m, 1.5500304, 1e-9);  // copied from the file by hand
  EXPECT_NEAR(s2.lasers[0].rot_rad, -0.1248942899601548, 1e-12);
  EXPECT_TRUE(s2.lasers[0].two_point);
  // Flag set, both near values zero: never measured.
  EXPECT_FALSE(load_calibration(test::data_path("calib/64e_utexas.yaml")).lasers[0].two_point);
}

TEST(CalibrationFile, BothFormsOfOneTableAgree) {
  LILO_NEED_DATA("sim_hdl64_town");
  const auto xml = load_calibration(test::data_path("sim_hdl64_town/db.xml"));
  const auto yaml = load_calibration(test::data_path("sim_hdl64_town/calibration.yaml"));
  test::expect_same(xml, yaml);
  EXPECT_NEAR(xml.lasers[0].rot_rad, -7.16 * kDeg, 1e-12);  // degrees in db.xml
  EXPECT_NEAR(xml.lasers[0].dist_m, 1.52, 1e-12);           // centimetres
  EXPECT_EQ(xml.lasers[1].min_intensity, 40);
}

TEST(CalibrationFile, ErrorsNameFileLineAndKey) {
  EXPECT_EQ(refusal(good_yaml()), "taken");
  EXPECT_NE(refusal("").find("found an empty file"), std::string::npos);
  EXPECT_NE(refusal("lasers: 3\n").find("expected a list \"lasers\""), std::string::npos);
  EXPECT_NE(refusal("lasers: [").find("calibration:"), std::string::npos);
  const std::string bad =
      refusal(replaced(good_yaml(), "  vert_correction: ", "  vert_correction: much"));
  EXPECT_NE(bad.find("vert_correction: expected a number, found \"much"), std::string::npos) << bad;
  EXPECT_NE(bad.find("calibration:4:"), std::string::npos) << bad;  // the line
  EXPECT_NE(refusal(replaced(good_yaml(), "laser_id: 7\n", "laser_id: 6\n")).find("stands twice"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(good_yaml(), "laser_id: 7\n", "laser_id: 64\n")).find("0 to 63"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(good_yaml(), "  vert_correction: ", "  vert_correction: 9.9 #"))
                .find("laser 0"),
            std::string::npos);
  EXPECT_NE(refusal("<a").find("XML"), std::string::npos);
  EXPECT_NE(refusal("<a/>").find("boost_serialization/DB/points_"), std::string::npos);
  EXPECT_THROW(load_calibration("/nowhere/at/all.yaml"), DriverError);
}

TEST(CalibrationFile, DeepNestingIsRefusedNotFollowed) {
  std::string xml, yaml;
  for (int i = 0; i < 100'000; ++i) {
    xml += "<a>";
    yaml += "[";
  }
  EXPECT_NE(refusal(xml), "taken");
  EXPECT_NE(refusal(yaml), "taken");
}

}  // namespace
}  // namespace lilo
