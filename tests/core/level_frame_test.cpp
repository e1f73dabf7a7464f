// SPDX-License-Identifier: BSD-3-Clause
// A tilted sensor is told of in its own axes.
#include "core/level_frame.hpp"

#include "core/feature_extractor.hpp"
#include "core/odometry.hpp"
#include "tests/core/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace lilo {
namespace {

const Eigen::Quaterniond kTilt = so3_exp({0.1, 0.2, 0.0});

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

/// A sensor nose down by 15 degrees, at 5 m/s along a road.
class TiltedSensor : public testing::Test {
 protected:
  static Pose at(double k) { return {so3_exp({0.0, kTilt_rad, 0.0}), {0.5 * k, 0.0, 0.0}}; }
  static Scan scan(std::uint64_t k) {
    return test::scan_of(
        test::road_with_posts(), test::even_beams(32, -25.0, 15.0), 900,
        [k](double s) { return at(static_cast<double>(k) + s); }, k);
  }
  static constexpr double kTilt_rad = 15.0 * std::numbers::pi / 180.0;
  static constexpr std::uint64_t kScans = 15;
};

TEST_F(TiltedSensor, IsTrackedInItsOwnAxes) {
  Odometry odometry{OdometryConfig{}};
  Estimate e;
  for (std::uint64_t k = 0; k < kScans; ++k) e = odometry.process(scan(k));
  const Pose truth = at(1.0).inverse() * at(static_cast<double>(kScans));
  EXPECT_EQ(e.status, TrackingStatus::tracking);
  EXPECT_LT(distance(e.T_odom_sensor, truth), 0.05);
  EXPECT_NEAR(e.twist.linear_mps.z(), 5.0 * std::sin(kTilt_rad), 0.05);
  EXPECT_NEAR(odometry.tilt_rad(), kTilt_rad, 0.003);
}

// The ground of the map and of the scan is a plane that rises ahead of the sensor.
TEST_F(TiltedSensor, ItsPointsAreInItsAxesToo) {
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
TEST_F(TiltedSensor, MayBeCoveredAtFirst) {
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
  EXPECT_NEAR(odometry.tilt_rad(), kTilt_rad, 0.003);
}

}  // namespace
}  // namespace lilo
