// SPDX-License-Identifier: BSD-3-Clause
#include "core/image/levelling.hpp"

#include "core/image/feature_image.hpp"
#include "tests/core/analytic_scene.hpp"
#include "tests/core/mounts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace lilo::core {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

/// By a sensor of 16 beams.
std::vector<Feature> seen_in(const test::Scene& scene, const Eigen::Quaterniond& R_world_sensor) {
  FeatureImage image(1024, {});
  return image.build(test::still_scan_of(scene, test::even_beams(16, -15.0, 15.0),
                                         {R_world_sensor, Eigen::Vector3d::Zero()}));
}

std::vector<Feature> seen_in_the_yard(const Eigen::Quaterniond& R_world_sensor) {
  return seen_in(test::yard(), R_world_sensor);
}

/// Ground features on a square of 20 x 20 m around the sensor, at that height (m).
template <typename Height>
std::vector<Feature> field(const Height& height_m) {
  std::vector<Feature> features;
  for (int x = -10; x <= 10; ++x) {
    for (int y = -10; y <= 10; ++y) {
      Feature f{};
      f.x_m = static_cast<float>(x);
      f.y_m = static_cast<float>(y);
      f.z_m = static_cast<float>(height_m(x, y));
      f.kind = FeatureKind::ground;
      features.push_back(f);
    }
  }
  return features;
}

Eigen::Quaterniond levelled(const std::vector<Feature>& features) {
  return Levelling().R_level_sensor(features);
}

// Of a rotation about a level axis the smallest one that makes the ground level is the rotation.
TEST(Levelling, FindsHowTheSensorIsTilted) {
  for (const Eigen::Vector3d& tilt_deg : std::vector<Eigen::Vector3d>{
           {0, 5, 0}, {0, 10, 0}, {0, -10, 0}, {12, 0, 0}, {-8, 15, 0}, {0, 25, 0}}) {
    const Eigen::Quaterniond tilt = so3_exp(tilt_deg * kDeg);
    EXPECT_LT(levelled(seen_in_the_yard(tilt)).angularDistance(tilt), 0.2 * kDeg)
        << tilt_deg.transpose();
  }
}

// Then the ground is above it.
TEST(Levelling, FindsThatTheSensorIsUpsideDown) {
  for (const double tilt_rad : {0.0, 0.1, -0.2}) {
    const Eigen::Quaterniond R_world_sensor = so3_exp({0.0, tilt_rad, 0.0}) * test::kUpsideDown;
    const Eigen::Vector3d up = R_world_sensor.conjugate() * Eigen::Vector3d::UnitZ();
    const Eigen::Quaterniond found = levelled(seen_in_the_yard(R_world_sensor));
    EXPECT_LT((found * up - Eigen::Vector3d::UnitZ()).norm(), 0.2 * kDeg) << tilt_rad;
  }
}

/// 40 m long, with a sensor of 16 beams in the middle.
std::vector<Feature> seen_in_a_hall(double width_m, double to_floor_m, double to_ceiling_m) {
  test::Scene hall;
  hall.planes = {{{0.0, 0.0, 1.0}, -to_floor_m},     {{0.0, 0.0, -1.0}, -to_ceiling_m},
                 {{0.0, -1.0, 0.0}, -0.5 * width_m}, {{0.0, 1.0, 0.0}, -0.5 * width_m},
                 {{-1.0, 0.0, 0.0}, -20.0},          {{1.0, 0.0, 0.0}, -20.0}};
  return seen_in(hall, Eigen::Quaterniond::Identity());
}

// Of a low ceiling it sees many times as much as of the floor.
TEST(Levelling, LeavesAnUprightSensorInAHall) {
  for (const double width_m : {8.0, 10.0, 16.0, 30.0}) {
    EXPECT_EQ(levelled(seen_in_a_hall(width_m, 1.8, 0.5)).w(), 1.0) << width_m;
    EXPECT_EQ(levelled(seen_in_a_hall(width_m, 2.5, 1.2)).w(), 1.0) << width_m;
    EXPECT_EQ(levelled(seen_in_a_hall(width_m, 3.5, 0.5)).w(), 1.0) << width_m;
  }
}

// Of whose floor it sees nothing.
TEST(Levelling, LeavesAnUprightSensorUnderACeiling) {
  const std::vector<Feature> few = field([](double, double) { return 1.0; });
  EXPECT_EQ(levelled(few).w(), 1.0) << "441 flat surfaces are too few for the ground";
  std::vector<Feature> above = few;
  for (int k = 0; k < 2; ++k) above.insert(above.end(), few.begin(), few.end());
  EXPECT_NE(levelled(above).w(), 1.0);
  for (Feature& f : above) f.y_m *= 0.3F;  // 6 m wide, as in a room
  EXPECT_EQ(levelled(above).w(), 1.0);
}

TEST(Levelling, LeavesASensorThatIsHardlyTilted) {
  EXPECT_EQ(levelled(seen_in_the_yard(so3_exp({0.0, 2.0 * kDeg, 0.0}))).w(), 1.0);
}

// Parked cars and tables are flat as well.
TEST(Levelling, TakesThePlaneOfMostFeatures) {
  const auto slope = [](double x, double y) { return 0.15 * x - 0.05 * y - 1.8; };
  const Eigen::Vector3d normal = Eigen::Vector3d(-0.15, 0.05, 1.0).normalized();
  const Eigen::Quaterniond found =
      levelled(field([&](double x, double y) { return slope(x, y) + (y > 3.5 ? 0.7 : 0.0); }));
  EXPECT_LT((found * normal - Eigen::Vector3d::UnitZ()).norm(), 0.2 * kDeg);
}

// Half of it is in no plane. What is, is tilted by 9 degrees.
TEST(Levelling, LeavesASensorOnRoughGround) {
  const auto slope = [](double x) { return 0.15 * x - 4.0; };
  EXPECT_EQ(levelled(field([&](double x, double y) {
              return slope(x) + (y > -1.5 ? 1.5 * std::sin(1.3 * x + 1.7 * y) : 0.0);
            })).w(),
            1.0);
}

// Stairs, or an embankment.
TEST(Levelling, LeavesASensorBeforeASteepSurface) {
  EXPECT_EQ(levelled(field([](double x, double) { return 0.65 * x - 8.0; })).w(), 1.0);
}

// 40 cm wide, and 10 cm rough: it may be tilted in any way about its length.
TEST(Levelling, LeavesASensorThatSeesAStrip) {
  std::vector<Feature> strip =
      field([](double x, double y) { return 0.1 * x - 1.8 + 0.05 * std::sin(7.0 * x + 13.0 * y); });
  for (Feature& f : strip) f.y_m *= 0.02F;
  EXPECT_EQ(levelled(strip).w(), 1.0);
}

TEST(Levelling, LeavesASensorThatSeesNoGround) {
  std::vector<Feature> walls = seen_in_the_yard(so3_exp({0.0, 10.0 * kDeg, 0.0}));
  for (Feature& f : walls) f.kind = FeatureKind::structure;
  EXPECT_EQ(levelled(walls).w(), 1.0);
}

}  // namespace
}  // namespace lilo::core
