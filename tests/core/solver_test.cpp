// SPDX-License-Identifier: BSD-3-Clause
// The solver by itself: a pose is found again from a map made at another one.
#include "core/registration/solver.hpp"

#include <gtest/gtest.h>

#include <random>

namespace lilo::core {
namespace {

constexpr double kSpan_s = 0.1;
constexpr double kFront_m = 6.1, kFloor_m = -1.4, kCeiling_m = 2.6;  // of the room

/// A room of 12 m by 9 m, 4 m high, the sensor in it. No wall lies on the border of cells: its
/// points would fall into those on one side only.
std::vector<Eigen::Vector3d> room(unsigned seed, int count) {
  constexpr double kBack_m = -5.9, kRight_m = -4.1, kLeft_m = 4.9;
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> x(kBack_m, kFront_m), y(kRight_m, kLeft_m),
      z(kFloor_m, kCeiling_m);
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < count; ++k) {
    const std::array<Eigen::Vector3d, 6> faces{Eigen::Vector3d{kFront_m, y(rng), z(rng)},
                                               {kBack_m, y(rng), z(rng)},
                                               {x(rng), kLeft_m, z(rng)},
                                               {x(rng), kRight_m, z(rng)},
                                               {x(rng), y(rng), kFloor_m},
                                               {x(rng), y(rng), kCeiling_m}};
    points.push_back(faces[static_cast<std::size_t>(k) % faces.size()]);
  }
  return points;
}

LocalMaps empty_maps() {
  const auto level = [](float cell_m) {
    const CellMapConfig config{.cell_m = cell_m, .capacity = 20000};
    return std::array{config, config};
  };
  return LocalMaps({level(0.25F), level(0.5F), level(1.5F)});
}

LocalMaps map_of(const std::vector<Eigen::Vector3d>& points, const Pose& T_odom_room,
                 std::size_t finest = LocalMaps::kWhole) {
  LocalMaps maps = empty_maps();
  std::vector<LocalMaps::Point> of_map;
  of_map.reserve(points.size());
  for (const Eigen::Vector3d& p : points) {
    of_map.push_back({T_odom_room * p, Eigen::Vector3f::Zero(), FeatureKind::structure});
  }
  maps.insert(of_map, finest);
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

/// 1000 features of a sensor in the room, with an error of 3 cm (1 sigma) in each coordinate.
std::vector<Feature> noisy_scan(unsigned seed, const Twist& twist) {
  std::vector<Feature> features = scan_of(room(seed, 1000), {}, twist);
  std::mt19937 rng(seed);
  std::normal_distribution<float> error_m(0.0F, 0.03F);
  for (Feature& f : features) {
    f.x_m += error_m(rng);
    f.y_m += error_m(rng);
    f.z_m += error_m(rng);
  }
  return features;
}

/// `reported_density`: of rotation.
Prior known_velocity(const Twist& twist, double density, double reported_density) {
  Prior prior = loose_prior({});
  prior.twist = twist;
  prior.begin_information = 1e6 * KnotInformation::Identity();
  prior.acceleration_density.setConstant(density);
  prior.reported_density.setConstant(density);
  prior.reported_density.head<3>().setConstant(reported_density);
  return prior;
}

TEST(Solver, ReportsTheEndOfTheTrajectoryUnderTheSameProcessNoise) {
  LocalMaps maps = map_of(room(1, 60000), {});
  const std::vector<Feature> scan = noisy_scan(2, {});
  Solver solver(kConfig, scan.size());
  const Solution found = solver.solve(scan, maps, known_velocity({}, 10.0, 10.0));
  const Pose apart = found.trajectory.end().inverse() * found.reported.T_odom_sensor;
  EXPECT_LT(apart.translation_m.norm() + so3_log(apart.rotation).norm(), 1e-9);
  EXPECT_TRUE(found.reported.information.isApprox(found.end_information, 1e-9));
}

// Where the motion is steadier than the process noise of the trajectory, the reported pose is less
// off, and knows it.
TEST(Solver, ReportsASteadyMotionWithLessNoise) {
  const Twist twist{{2.0, 0.0, 0.0}, {0.0, 0.0, 0.3}};
  LocalMaps maps = map_of(room(1, 60000), {});
  double of_trajectory = 0.0, of_reported = 0.0;
  for (unsigned seed = 2; seed < 22; ++seed) {
    const std::vector<Feature> scan = noisy_scan(seed, twist);
    Solver solver(kConfig, scan.size());
    const Solution found = solver.solve(scan, maps, known_velocity(twist, 3.0, 0.03));
    const Pose to_truth = moved({}, twist, kSpan_s).inverse();
    of_trajectory += so3_log((to_truth * found.trajectory.end()).rotation).squaredNorm();
    of_reported += so3_log((to_truth * found.reported.T_odom_sensor).rotation).squaredNorm();
    EXPECT_GT(found.reported.information(2, 2), found.end_information(2, 2));
  }
  EXPECT_LT(of_reported, 0.7 * of_trajectory);
}

// The yaw rate jumps to 1 rad/s as the scan begins.
TEST(Solver, ReportsAnAbruptTurnUnderLittleProcessNoise) {
  const Twist turn{Eigen::Vector3d::Zero(), {0.0, 0.0, 1.0}};
  LocalMaps maps = map_of(room(1, 60000), {});
  const std::vector<Feature> scan = scan_of(room(2, 3000), {}, turn);
  Solver solver(kConfig, scan.size());
  const Solution found = solver.solve(scan, maps, known_velocity({}, 10.0, 0.01));
  EXPECT_NEAR(so3_log(found.reported.T_odom_sensor.rotation).z(), 0.1, 0.01);
}

/// A room whose front wall was seen from the next room only, where its face is so much farther.
LocalMaps map_with_wall_from_behind(double wall_m) {
  LocalMaps maps = empty_maps();
  std::vector<LocalMaps::Point> of_map;
  for (Eigen::Vector3d p : room(1, 60000)) {
    Eigen::Vector3f ray = p.cast<float>().normalized();
    if (p.x() == kFront_m) {
      ray = {-1.0F, 0.0F, 0.0F};
      p.x() += wall_m;
    }
    of_map.push_back({p, Eigen::Vector3f::Zero(), FeatureKind::structure, ray});
  }
  maps.insert(of_map, LocalMaps::kWhole);
  return maps;
}

// The back wall alone holds the sensor then. With both, it is half of the wall's width off.
TEST(Solver, MatchesAWallFromTheSideThatWasSeen) {
  constexpr double kWidth_m = 0.1;
  LocalMaps maps = map_with_wall_from_behind(kWidth_m);
  const std::vector<Feature> scan = scan_of(room(2, 3000), {}, {});
  Solver solver({.max_iterations = 20, .structure_kernel = 100.0F}, scan.size());
  const auto found = [&](Sides sides) {
    return solver.solve(scan, maps, loose_prior({}), Levels::from_whole, sides);
  };
  EXPECT_NEAR(found(Sides::seen).trajectory.at(0.5).translation_m.x(), 0.0, 0.005);
  EXPECT_NEAR(found(Sides::both).trajectory.at(0.5).translation_m.x(), 0.5 * kWidth_m, 0.01);
  EXPECT_LT(found(Sides::seen).matched, found(Sides::both).matched);
}

/// Seats and shelves beside the sensor: points of all heights from `lowest_m` on.
std::vector<Eigen::Vector3d> clutter(unsigned seed, double lowest_m, double height_m, int count) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> x(-3.0, 3.0), y(1.0, 4.0),
      z(lowest_m, lowest_m + height_m);
  std::vector<Eigen::Vector3d> points;
  points.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) points.emplace_back(x(rng), y(rng), z(rng));
  return points;
}

std::vector<Eigen::Vector3d> walls_of_room(unsigned seed, int count) {
  std::vector<Eigen::Vector3d> points = room(seed, count);
  std::erase_if(points, [](const Eigen::Vector3d& p) {
    return p.z() < kFloor_m + 0.1 || p.z() > kCeiling_m - 0.1;
  });
  return points;
}

// Of clutter 0.24 m high the sensor sees the lower half. Whole cells, whose window is 1.5 m wide,
// take all of it for a surface of its mean height. Half cells know that it is none.
TEST(Solver, TheSmallestKnownCellDoesNotTakeClutterForASurface) {
  constexpr double kLowest_m = -0.9, kHeight_m = 0.24;
  std::vector<Eigen::Vector3d> seen_before = walls_of_room(1, 60000);
  for (const Eigen::Vector3d& p : clutter(4, kLowest_m, kHeight_m, 20000)) seen_before.push_back(p);
  LocalMaps maps = map_of(seen_before, {}, LocalMaps::kHalf);
  std::vector<Eigen::Vector3d> seen = walls_of_room(2, 3000);
  for (const Eigen::Vector3d& p : clutter(5, kLowest_m, 0.5 * kHeight_m, 500)) seen.push_back(p);
  const std::vector<Feature> scan = scan_of(seen, {}, {});
  Solver solver(kConfig, scan.size());
  const auto height_m = [&](Levels levels) {
    return solver.solve(scan, maps, loose_prior({}), levels).trajectory.at(0.5).translation_m.z();
  };
  EXPECT_NEAR(height_m(Levels::first_known), 0.0, 0.01);
  EXPECT_NEAR(height_m(Levels::from_half), 0.25 * kHeight_m, 0.02);
}

/// The distance of a wall ahead, which lies on no border of cells either.
constexpr double kWall_m = 10.1;

/// Two walls ahead that disagree: what is low says that the sensor came `low_m` forward, what is
/// tall that it did not move.
std::vector<Feature> walls_that_disagree(double low_m, int low, int tall) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<float> side(-4.0F, 4.0F), height(0.0F, 2.0F);
  std::vector<Feature> features;
  for (int k = 0; k < low + tall; ++k) {
    const bool is_tall = k >= low;
    const auto x_m = static_cast<float>(is_tall ? kWall_m : kWall_m - low_m);
    const float z_m = height(rng) + (is_tall ? 3.0F : 0.0F);
    features.push_back({x_m, side(rng), z_m, 0.5F, 0.0F, 0.0F, 0.0F, FeatureKind::structure, 0});
  }
  return features;
}

LocalMaps wall_map() {
  std::mt19937 rng(4);
  std::uniform_real_distribution<double> side(-6.0, 6.0), height(-1.0, 6.0), rough(-0.1, 0.1);
  std::vector<Eigen::Vector3d> points;
  points.reserve(60000);
  for (int k = 0; k < 60000; ++k) {
    Eigen::Vector3d& p = points.emplace_back();  // one by one: the order of arguments is free
    p.x() = kWall_m + rough(rng);
    p.y() = side(rng);
    p.z() = height(rng);
  }
  return map_of(points, {});
}

/// Along a wall ahead at `speed_mps`; only the way to it is not known. A wall does not hold the
/// sensor along itself: features would slide into other cells.
Prior along_a_wall(double speed_mps) {
  Prior prior = loose_prior({});
  prior.twist.linear_mps.y() = speed_mps;
  constexpr int kForward = 3, kForwardSpeed = 9;
  for (int k = 0; k < kKnotSize; ++k) {
    if (k == kForward || k == kForwardSpeed) continue;
    prior.begin_information(k, k) = 1e12;
    if (k < 6) prior.acceleration_density[k] = 1e-8;
  }
  return prior;
}

// A mean with the weights: 600 low and 200 tall features, of 3 cm and 0. Both are inliers alike.
TEST(Solver, BelievesWhatIsTallMoreWhereTheSensorIsSlow) {
  constexpr double kLow_m = 0.03, kLow = 600.0, kTall = 200.0, kWeight = 7.0;
  const std::vector<Feature> scan = walls_that_disagree(kLow_m, 600, 200);
  LocalMaps maps = wall_map();
  Solver solver({.max_iterations = 20, .structure_kernel = 100.0F}, scan.size());
  for (const double speed_mps : {0.0, 4.0, 6.0}) {
    const Solution found = solver.solve(scan, maps, along_a_wall(speed_mps));
    const double weight = speed_mps < 5.0 ? kWeight : 1.0;
    const double mean_m = kLow_m * kLow / (kLow + weight * kTall);
    EXPECT_NEAR(found.trajectory.at(0.5).translation_m.x(), mean_m, 0.002) << speed_mps;
  }
}

// That the sensor did not move, whatever the weights make of it.
TEST(Solver, TellsWhatTallStructureAloneSaysWhereTheSensorIsSlow) {
  const std::vector<Feature> scan = walls_that_disagree(0.03, 600, 200);
  LocalMaps maps = wall_map();
  Solver solver({.max_iterations = 20, .structure_kernel = 100.0F}, scan.size());
  const Solution slow = solver.solve(scan, maps, along_a_wall(4.0));
  ASSERT_TRUE(slow.tall.is_slow);
  const double back_m = slow.tall.gradient.x() / slow.tall.information(0, 0);
  EXPECT_NEAR(back_m, -slow.trajectory.at(0.5).translation_m.x(), 0.002);
  EXPECT_LT(slow.tall.information(1, 1), 0.01 * slow.tall.information(0, 0)) << "along the wall";
  const Solution fast = solver.solve(scan, maps, along_a_wall(6.0));
  EXPECT_FALSE(fast.tall.is_slow);
  EXPECT_TRUE(fast.tall.information.isZero(0.0));
}

// The covariance is to be that of the same number of features.
TEST(Solver, KeepsTheInformationOfAllStructureWhereItsHeightsAreWeighted) {
  const std::vector<Feature> scan = walls_that_disagree(0.0, 600, 200);
  LocalMaps maps = wall_map();
  Solver solver({.max_iterations = 20, .structure_kernel = 100.0F}, scan.size());
  std::vector<double> information;
  for (const double speed_mps : {0.0, 6.0}) {
    const Solution found = solver.solve(scan, maps, along_a_wall(speed_mps));
    information.push_back(found.data_information(3, 3));
  }
  EXPECT_NEAR(information[0] / information[1], 1.0, 0.05);
}

// As foliage: it is tall and says nothing.
TEST(Solver, GivesNoWeightToWhatIsTallAndHasNoInformation) {
  std::vector<Feature> scan = walls_that_disagree(0.0, 600, 600);
  for (std::size_t k = 600; k < scan.size(); ++k) scan[k].y_m += 100.0F;  // where the map is empty
  LocalMaps maps = wall_map();
  Solver solver({.max_iterations = 20, .structure_kernel = 100.0F}, scan.size());
  const auto information_at = [&](double speed_mps) {
    return solver.solve(scan, maps, along_a_wall(speed_mps)).data_information(3, 3);
  };
  EXPECT_NEAR(information_at(0.0) / information_at(6.0), 1.0, 0.05);
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
