// SPDX-License-Identifier: BSD-3-Clause
// The solver by itself: a pose is found again from a map made at another one.
#include "core/registration/solver.hpp"

#include <gtest/gtest.h>

#include <random>

namespace lilo::core {
namespace {

constexpr double kSpan_s = 0.1;

/// A room of 12 m by 9 m, 4 m high, the sensor in it.
std::vector<Eigen::Vector3d> room(unsigned seed, int count) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> x(-6.0, 6.0), y(-4.0, 5.0), z(-1.5, 2.5);
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < count; ++k) {
    const std::array<Eigen::Vector3d, 6> faces{Eigen::Vector3d{6.0, y(rng), z(rng)},
                                               {-6.0, y(rng), z(rng)},
                                               {x(rng), 5.0, z(rng)},
                                               {x(rng), -4.0, z(rng)},
                                               {x(rng), y(rng), -1.5},
                                               {x(rng), y(rng), 2.5}};
    points.push_back(faces[static_cast<std::size_t>(k) % faces.size()]);
  }
  return points;
}

LocalMaps map_of(const std::vector<Eigen::Vector3d>& points, const Pose& T_odom_room) {
  const auto level = [](float cell_m) {
    const CellMapConfig config{.cell_m = cell_m, .capacity = 20000};
    return std::array{config, config};
  };
  LocalMaps maps({level(0.25F), level(0.5F), level(1.5F)});
  std::vector<LocalMaps::Point> of_map;
  of_map.reserve(points.size());
  for (const Eigen::Vector3d& p : points) {
    of_map.push_back({T_odom_room * p, Eigen::Vector3f::Zero(), FeatureKind::structure});
  }
  maps.insert(of_map, LocalMaps::kWhole);
  return maps;
}

/// What a sensor at `T_room_sensor` sees, at constant twist during the scan.
std::vector<Feature> scan_of(const std::vector<Eigen::Vector3d>& points, const Pose& T_begin,
                             const Twist& twist) {
  std::vector<Feature> features;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double s = static_cast<double>(k) / static_cast<double>(points.size());
    const Eigen::Vector3f p =
        (moved(T_begin, twist, s * kSpan_s).inverse() * points[k]).cast<float>();
    features.push_back(
        {p.x(), p.y(), p.z(), static_cast<float>(s), 0.0F, 0.0F, 0.0F, FeatureKind::structure, 0});
  }
  return features;
}

Prior loose_prior(const Pose& T_begin) {
  Prior prior;
  prior.T_begin = T_begin;
  prior.span_s = kSpan_s;
  prior.segments = 2;
  prior.acceleration_density = Vector6d::Constant(10.0);
  prior.begin_information = 1e-2 * KnotInformation::Identity();
  return prior;
}

constexpr SolverConfig kConfig{.max_iterations = 20};

TEST(Solver, FindsTheMotionWithinAScan) {
  const Twist twist{{2.0, 0.5, 0.0}, {0.0, 0.1, 0.6}};
  LocalMaps maps = map_of(room(1, 60000), {});
  const std::vector<Feature> scan = scan_of(room(2, 3000), {}, twist);
  Solver solver(kConfig, scan.size());
  const Solution found = solver.solve(scan, maps, loose_prior({}));
  EXPECT_TRUE(found.converged);
  const Pose error = moved({}, twist, kSpan_s).inverse() * found.trajectory.end();
  EXPECT_LT(error.translation_m.norm(), 0.01);
  EXPECT_LT(so3_log(error.rotation).norm(), 0.005);
  EXPECT_LT((found.trajectory.end_twist().linear_mps - twist.linear_mps).norm(), 0.3);
}

// The map's cells lie otherwise in the room then, and all axes are others.
TEST(Solver, DoesNotCareHowTheOdometryFrameIsTurned) {
  const Twist twist{{1.0, -0.5, 0.2}, {0.05, 0.0, 0.4}};
  const std::vector<Feature> scan = scan_of(room(2, 3000), {}, twist);
  for (const double angle_rad : {0.4, 1.1, 2.5}) {
    const Pose T{so3_exp(angle_rad * Eigen::Vector3d(0.6, 0.0, 0.8)), {30.0, -70.0, 11.0}};
    LocalMaps maps = map_of(room(1, 60000), T);
    Solver solver(kConfig, scan.size());
    const Solution found = solver.solve(scan, maps, loose_prior(T));
    const Pose error = (T * moved({}, twist, kSpan_s)).inverse() * found.trajectory.end();
    EXPECT_LT(error.translation_m.norm(), 0.01) << angle_rad;
    EXPECT_LT(so3_log(error.rotation).norm(), 0.005) << angle_rad;
  }
}

}  // namespace
}  // namespace lilo::core
