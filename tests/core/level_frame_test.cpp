// SPDX-License-Identifier: BSD-3-Clause
// A tilted sensor is told of in its own axes.
#include "core/level_frame.hpp"

#include "core/calibration/beam_correction.hpp"
#include "core/feature_extractor.hpp"
#include "core/odometry.hpp"
#include "tests/core/analytic_scene.hpp"
#include "tests/core/mounts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace lilo {
namespace {

const Eigen::Quaterniond kTilt = so3_exp({0.1, 0.2, 0.0});
using test::kNoseDown, test::kUpsideDown;

Pose turn(const Eigen::Quaterniond& rotation) { return {rotation, Eigen::Vector3d::Zero()}; }

double distance(const Pose& a, const Pose& b) { return magnitude_m(a.inverse() * b); }

// A pose is the same motion in other axes, and all vectors turn with them.
TEST(InSensorAxes, TurnsTheEstimate) {
  Estimate e;
  e.T_odom_sensor = {so3_exp({0.1, 0.2, 0.3}), {4.0, 5.0, 6.0}};
  e.twist = {{7.0, 0.0, 1.0}, {0.0, 0.2, 0.5}};
  Vector6d error;
  error << 0.1, 0.2, 0.3, 0.04, -0.05, 0.06;
  e.covariance = error * error.transpose();
  e.weak_directions[0].direction = error.normalized();
  const auto turned = [](const Vector6d& v) {
    Vector6d out;
    out << kTilt * v.head<3>(), kTilt * v.tail<3>();
    return out;
  };
  Estimate level;
  level.T_odom_sensor = turn(kTilt) * e.T_odom_sensor * turn(kTilt.conjugate());
  level.twist = {kTilt * e.twist.linear_mps, kTilt * e.twist.angular_radps};
  level.covariance = turned(error) * turned(error).transpose();
  level.weak_directions[0].direction = turned(error.normalized());
  const Estimate found = in_sensor_axes(level, kTilt);
  EXPECT_LT(distance(found.T_odom_sensor, e.T_odom_sensor), 1e-9);
  EXPECT_LT((found.twist.linear_mps - e.twist.linear_mps).norm(), 1e-9);
  EXPECT_LT((found.twist.angular_radps - e.twist.angular_radps).norm(), 1e-9);
  EXPECT_LT((found.covariance - e.covariance).norm(), 1e-9);
  EXPECT_LT((found.weak_directions[0].direction - e.weak_directions[0].direction).norm(), 1e-9);
}

TEST(InLevelAxes, TurnsTheRingsOfAnUpsideDownSensorOver) {
  const BeamTable beams = test::even_beams(3, -10.0, 4.0);  // and -3
  EXPECT_EQ(in_level_axes(beams, kTilt).elevation_rad, beams.elevation_rad);
  const BeamTable turned_over = in_level_axes(beams, kTilt * kUpsideDown);
  EXPECT_EQ(turned_over.ring_count, 3);
  for (std::size_t ring = 0; ring < 3; ++ring)
    EXPECT_EQ(turned_over.elevation_rad[ring], -beams.elevation_rad[2 - ring]) << ring;
}

/// A point of this ring, corrected.
Eigen::Vector3f corrected(const Eigen::Vector3f& p_m, std::uint8_t ring,
                          const BeamEstimate& beams) {
  core::BeamCorrection correction;
  correction.elevation_rad = beams.elevation_rad;
  correction.eccentricity_rad = {beams.eccentricity_rad[0], beams.eccentricity_rad[1]};
  correction.common_part.fill(1.0F);
  correction.common_elevation_rad = beams.common_elevation_rad;
  std::vector<Feature> features{{.x_m = p_m.x(), .y_m = p_m.y(), .z_m = p_m.z()}};
  features[0].ring = ring;
  correction.apply(features);
  return {features[0].x_m, features[0].y_m, features[0].z_m};
}

TEST(InLevelAxes, TheErrorsOfBeamsMoveTheSamePointsTheSameWay) {
  BeamEstimate beams;
  beams.ring_count = 16;
  beams.elevation_rad[3] = 1.5e-3;
  beams.elevation_rad[12] = -3e-3;
  beams.elevation_sigma_rad[3] = 1e-4;
  beams.eccentricity_rad = {1e-3, -0.5e-3};
  beams.common_elevation_rad = beams.common_by_path_rad = 0.7e-3;
  const BeamEstimate level = in_level_axes(beams, kUpsideDown);
  for (const Eigen::Vector3f& p_m :
       {Eigen::Vector3f(20.0F, 3.0F, -4.0F), Eigen::Vector3f(-7.0F, 15.0F, 2.0F)}) {
    const Eigen::Quaternionf turn = kUpsideDown.cast<float>();
    const Eigen::Vector3f moved_m = turn * corrected(p_m, 3, beams);
    EXPECT_LT((moved_m - corrected(turn * p_m, 12, level)).norm(), 1e-5F);
    EXPECT_GT((moved_m - turn * p_m).norm(), 0.02F);
  }
  EXPECT_EQ(level.elevation_sigma_rad[12], 1e-4);
  EXPECT_EQ(level.common_by_path_rad, -0.7e-3);
  EXPECT_EQ(in_sensor_axes(level, kUpsideDown), beams);
  EXPECT_EQ(in_level_axes(beams, kTilt), beams);
}

/// A sensor at 5 m/s along a road, however it is mounted.
class MountedSensor : public testing::TestWithParam<Eigen::Quaterniond> {
 protected:
  static Pose at(double k) { return {GetParam(), {0.5 * k, 0.0, 0.0}}; }
  static Scan scan(std::uint64_t k) {
    return test::scan_of(
        test::road_with_posts(), in_level_axes(test::even_beams(32, -25.0, 15.0), GetParam()), 900,
        [k](double s) { return at(static_cast<double>(k) + s); }, k);
  }
  static double tilt_rad() { return std::acos((GetParam() * Eigen::Vector3d::UnitZ()).z()); }
  static constexpr std::uint64_t kScans = 15;
};

TEST_P(MountedSensor, IsTrackedInItsOwnAxes) {
  Odometry odometry{OdometryConfig{}};
  Estimate e;
  for (std::uint64_t k = 0; k < kScans; ++k) e = odometry.process(scan(k));
  const Pose truth = at(1.0).inverse() * at(static_cast<double>(kScans));
  EXPECT_EQ(e.status, TrackingStatus::tracking);
  EXPECT_LT(distance(e.T_odom_sensor, truth), 0.05);
  const Eigen::Vector3d forward_mps(5.0, 0.0, 0.0);
  EXPECT_NEAR(e.twist.linear_mps.z(), (GetParam().conjugate() * forward_mps).z(), 0.05);
  EXPECT_NEAR(odometry.tilt_rad(), tilt_rad(), 0.003);
}

// The ground of the map and of the scan is where it is to the sensor.
TEST_P(MountedSensor, ItsPointsAreInItsAxesToo) {
  Odometry odometry{OdometryConfig{}};
  std::vector<Eigen::Vector3f> aligned_m, mapped_m;
  for (std::uint64_t k = 0; k < kScans || mapped_m.empty(); ++k) {
    odometry.process(scan(k));
    odometry.aligned_points(2000, aligned_m);
    odometry.mapped_points(2000, mapped_m);  // none of most scans
    ASSERT_LT(k, 2 * kScans);
  }
  const Eigen::Matrix3f R_world_sensor = at(0.0).rotation.toRotationMatrix().cast<float>();
  for (const auto& points_m : {odometry.map_points(), aligned_m, mapped_m}) {
    ASSERT_GT(points_m.size(), 100U);
    const auto on_ground = std::count_if(points_m.begin(), points_m.end(), [&](const auto& p) {
      return std::abs((R_world_sensor * p).z() + 1.8F) < 0.1F;
    });
    EXPECT_GT(2 * on_ground, std::ssize(points_m));
  }
}

// Its first scan has fewer than 100 features, which tell nothing.
TEST_P(MountedSensor, MayBeCoveredAtFirst) {
  FeatureExtractor extractor{OdometryConfig{}};
  Odometry odometry{OdometryConfig{}};
  ScanFeatures features;
  Estimate second, e;
  for (std::uint64_t k = 0; k < kScans; ++k) {
    Scan some = scan(k);
    if (k == 0) some.returns.resize(90);
    extractor.finish(some, features);
    EXPECT_EQ(features.all.empty(), k == 0);
    e = odometry.align(some, features);
    odometry.update_map(features);
    if (k == 1) second = e;
  }
  const Pose truth = at(2.0).inverse() * at(static_cast<double>(kScans));
  EXPECT_LT(distance(second.T_odom_sensor.inverse() * e.T_odom_sensor, truth), 0.05);
  EXPECT_EQ(e.status, TrackingStatus::tracking);
  EXPECT_NEAR(odometry.tilt_rad(), tilt_rad(), 0.003);
}

std::string name_of(const testing::TestParamInfo<Eigen::Quaterniond>& mount) {
  constexpr std::array kNames = {"NoseDown", "UpsideDown", "UpsideDownAndNoseDown"};
  return kNames.at(mount.index);
}
const Eigen::Quaterniond kBoth = kNoseDown * kUpsideDown;
INSTANTIATE_TEST_SUITE_P(Mounts, MountedSensor, testing::Values(kNoseDown, kUpsideDown, kBoth),
                         name_of);

}  // namespace
}  // namespace lilo
