#include "core/odometry.hpp"
#include "core/paper/registration.hpp"
#include "tests/core/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <random>

namespace lilo::paper {
namespace {

Eigen::Vector3d random_vector(std::mt19937& rng, double scale) {
  std::uniform_real_distribution<double> u(-scale, scale);
  return {u(rng), u(rng), u(rng)};
}

Pose stepped(const Pose& T, int axis, double h) {
  Pose moved = T;
  if (axis < 3) {
    moved.rotation = (so3_exp(h * Eigen::Vector3d::Unit(axis)) * T.rotation).normalized();
  } else {
    moved.translation_m += h * Eigen::Vector3d::Unit(axis - 3);
  }
  return moved;
}

TEST(Residuals, AnalyticJacobiansEqualNumericOnes) {
  constexpr double h = 1e-6;
  std::mt19937 rng(7);
  for (int k = 0; k < 50; ++k) {
    const Pose T{so3_exp(random_vector(rng, 1.0)), random_vector(rng, 50.0)};
    const Eigen::Vector3d p = random_vector(rng, 20.0);
    const Primitive primitive{random_vector(rng, 60.0), random_vector(rng, 1.0).normalized(), true};
    const LineResidual line = line_residual(T, p, primitive);
    const PlaneResidual plane = plane_residual(T, p, primitive);
    for (int axis = 0; axis < 6; ++axis) {
      const Pose ahead = stepped(T, axis, h), behind = stepped(T, axis, -h);
      const Eigen::Vector3d d_line =
          (line_residual(ahead, p, primitive).value - line_residual(behind, p, primitive).value) /
          (2.0 * h);
      const double d_plane =
          (plane_residual(ahead, p, primitive).value - plane_residual(behind, p, primitive).value) /
          (2.0 * h);
      EXPECT_NEAR((d_line - line.jacobian.col(axis)).norm(), 0.0, 1e-6);
      EXPECT_NEAR(d_plane - plane.jacobian(axis), 0.0, 1e-6);
    }
  }
}

TEST(Residuals, LineResidualIsTheDistanceOfEquation22) {
  std::mt19937 rng(8);
  const Pose T{so3_exp(random_vector(rng, 1.0)), random_vector(rng, 5.0)};
  const Eigen::Vector3d p = random_vector(rng, 5.0);
  const Primitive line{random_vector(rng, 5.0), random_vector(rng, 1.0).normalized(), true};
  const Eigen::Vector3d cross = (T * p - line.point).cross(line.axis);
  const double f_E = (cross / cross.norm()).dot(cross);  // Eqs. 22 and 23 as printed
  EXPECT_NEAR(line_residual(T, p, line).value.norm(), f_E, 1e-12);
}

TEST(Fits, FindTheLineAndThePlaneTheirPointsCameFrom) {
  std::mt19937 rng(9);
  std::normal_distribution<double> noise(0.0, 0.005);
  std::uniform_real_distribution<double> along(-1.0, 1.0);
  const Eigen::Vector3d axis = random_vector(rng, 1.0).normalized();
  const Eigen::Vector3d side = axis.unitOrthogonal();
  Cloud line, plane;
  std::vector<int> indices;
  for (int k = 0; k < 40; ++k) {
    Point on_line, on_plane;
    on_line.getVector3fMap() =
        (along(rng) * axis + Eigen::Vector3d(noise(rng), noise(rng), noise(rng))).cast<float>();
    on_plane.getVector3fMap() =
        (along(rng) * side + along(rng) * axis.cross(side) + noise(rng) * axis).cast<float>();
    line.push_back(on_line);
    plane.push_back(on_plane);
    indices.push_back(k);
  }
  const Primitive found_line = fit_line(line, indices), found_plane = fit_plane(plane, indices);
  ASSERT_TRUE(found_line.valid && found_plane.valid);
  EXPECT_GT(std::abs(found_line.axis.dot(axis)), std::cos(0.02));
  EXPECT_GT(std::abs(found_plane.axis.dot(axis)), std::cos(0.02));
  EXPECT_FALSE(fit_line(plane, indices).valid);
  EXPECT_FALSE(fit_plane(line, {0, 1, 2, 3}).valid);  // too few
}

const BeamTable k16 = test::even_beams(16, -15.0, 15.0);

OdometryConfig config_16() {
  OdometryConfig config;
  config.profile = Profile::paper;
  config.paper.interpolated_rows = 32;
  config.paper.ground_filter = GroundFilter::fourier;
  return config;
}

Scan second_scan(const test::Scene& scene, const Pose& T) {
  Scan scan = test::still_scan_of(scene, k16, T);
  scan.index = 1;
  scan.motion_compensated = true;
  scan.start_ns += 100'000'000;
  scan.end_ns += 100'000'000;
  return scan;
}

TEST(PaperOdometry, RecoversAKnownStepBetweenTwoScans) {
  const Pose step{so3_exp({0.01, -0.015, 0.05}), {0.4, -0.1, 0.05}};
  Odometry odometry(config_16());
  odometry.process(test::still_scan_of(test::yard(), k16, {}));
  const Estimate e = odometry.process(second_scan(test::yard(), step));
  const Pose error = step.inverse() * e.T_odom_sensor;
  EXPECT_LT(error.translation_m.norm(), 0.02);
  EXPECT_LT(so3_log(error.rotation).norm(), 0.002);
}

/// The yard as seen by a world whose axes are turned by `yaw_rad` about z.
test::Scene turned(test::Scene scene, double yaw_rad) {
  const Eigen::Quaterniond R = so3_exp({0.0, 0.0, yaw_rad});
  for (test::Plane& plane : scene.planes) plane.normal = R * plane.normal;
  for (test::Pole& pole : scene.poles) {
    const Eigen::Vector3d at = R * Eigen::Vector3d(pole.x_m, pole.y_m, 0.0);
    pole.x_m = at.x();
    pole.y_m = at.y();
  }
  return scene;
}

TEST(PaperOdometry, RotatingTheProblemRotatesTheAnswer) {
  const Pose step{so3_exp({0.01, -0.015, 0.05}), {0.4, -0.1, 0.05}};
  for (const double yaw_rad : {0.0, 0.7, -2.1}) {
    const Pose turn{so3_exp({0.0, 0.0, yaw_rad}), Eigen::Vector3d::Zero()};
    const Pose expected = turn * step * turn.inverse();
    const test::Scene scene = turned(test::yard(), yaw_rad);
    Odometry odometry(config_16());
    odometry.process(test::still_scan_of(scene, k16, {}));
    const Pose found = odometry.process(second_scan(scene, expected)).T_odom_sensor;
    const Pose error = expected.inverse() * found;
    EXPECT_LT(error.translation_m.norm(), 0.03) << yaw_rad;
    EXPECT_LT(so3_log(error.rotation).norm(), 0.003) << yaw_rad;
  }
}

/// Error of the last pose after two seconds of speeding up to `speed_mps` and turning.
double final_error_m(double speed_mps, bool deskew) {
  const auto pose_at = [&](double t_s) {
    const double x_m = 0.25 * speed_mps * t_s * t_s;
    return Pose{so3_exp({0.0, 0.0, 0.05 * t_s * t_s}), {x_m - 8.0, 0.1 * x_m, 0.0}};
  };
  Odometry odometry(config_16());
  Pose T_world_first;
  Pose error;
  for (std::uint64_t k = 0; k < 20; ++k) {
    const double start_s = 0.1 * static_cast<double>(k);
    Scan scan = test::scan_of(
        test::yard(), k16, 1800, [&](double s) { return pose_at(start_s + 0.1 * s); }, k);
    scan.motion_compensated = !deskew;
    const Estimate e = odometry.process(scan);
    const Pose truth = pose_at(start_s + 0.1);
    if (k == 0) T_world_first = truth;
    error = truth.inverse() * T_world_first * e.T_odom_sensor;
  }
  return error.translation_m.norm();
}

TEST(PaperOdometry, DeskewingAMovingSensorIsWorthIt) {
  const double with = final_error_m(10.0, true);
  EXPECT_LT(with, 0.5);  // 10 m driven, at 1 m a scan in the end
  EXPECT_LT(with, 0.5 * final_error_m(10.0, false));
}

TEST(PaperOdometry, AnEmptyScanIsReportedAsLostAndDoesNotMoveThePose) {
  Odometry odometry(config_16());
  odometry.process(test::still_scan_of(test::yard(), k16, {}));
  Scan empty;
  empty.index = 1;
  empty.start_ns = 1'100'000'000;
  empty.end_ns = 1'200'000'000;
  empty.beams = k16;
  const Estimate e = odometry.process(empty);
  EXPECT_EQ(e.status, TrackingStatus::lost);
  EXPECT_NEAR(e.T_odom_sensor.translation_m.norm(), 0.0, 1e-9);
}

TEST(PaperOdometry, AScanWithoutBeamsIsNoReasonToThrow) {
  Odometry odometry(config_16());
  EXPECT_NO_THROW(odometry.process(Scan{}));
  EXPECT_NO_THROW(odometry.process(Scan{}));
}

}  // namespace
}  // namespace lilo::paper
