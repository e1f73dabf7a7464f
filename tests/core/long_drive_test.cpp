// SPDX-License-Identifier: BSD-3-Clause
// What a scan costs is bounded by the features, the map and the steps it takes; none of them may
// grow with the way travelled. Times are measured by `lilo run`, not here.
#include "core/odometry.hpp"
#include "tests/core/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <unistd.h>

namespace lilo {
namespace {

constexpr double kSpeed_mps = 20.0;
constexpr int kScans = 1000, kTenth = kScans / 10;

Pose on_the_road(double time_s) {
  const double x_m = kSpeed_mps * time_s, yaw_rad = 0.1 * std::cos(x_m / 40.0);
  const double swing_rad = 0.004 * std::sin(12.0 * time_s);
  return {so3_exp({swing_rad, -swing_rad, yaw_rad}), {x_m, 4.0 * std::sin(x_m / 40.0), 0.0}};
}

/// The part of an endless road that is seen from `x_m`: trunks and round towers on both sides.
test::Scene road_at(double x_m) {
  constexpr double kSight_m = 60.0, kSpacing_m = 6.0;
  test::Scene road;
  road.max_range_m = kSight_m;
  road.planes = {{{0.0, 0.0, 1.0}, -1.8}};
  const int first = static_cast<int>(std::floor((x_m - kSight_m) / kSpacing_m));
  for (int k = first; k * kSpacing_m < x_m + kSight_m + kSpacing_m; ++k) {
    const double side = k % 2 == 0 ? 1.0 : -1.0, beside_m = 10.0 + 4.0 * std::sin(5.0 * k);
    const double radius_m = k % 5 == 0 ? 2.0 : 0.3;
    road.poles.push_back(
        {kSpacing_m * k + 2.0 * std::sin(3.0 * k), side * beside_m, radius_m, 6.0});
  }
  return road;
}

double resident_mb() {
  long size = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> size >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) * 1e-6;
}

/// Means over a tenth of the drive.
struct Cost {
  double features = 0.0, map_cells = 0.0, residuals = 0.0, steps = 0.0, memory_mb = 0.0;
  void add(const Estimate& e) {
    features += static_cast<double>(e.ground_count + e.structure_count) / kTenth;
    map_cells += static_cast<double>(e.map_cell_count) / kTenth;
    residuals += static_cast<double>(e.correspondence_count) / kTenth;
    steps += static_cast<double>(e.iterations) / kTenth;
    memory_mb += resident_mb() / kTenth;
  }
};

void print(const char* when, const Cost& c) {
  std::printf("%s tenth: %.0f features, %.0f cells, %.0f residuals, %.2f steps, %.1f MB\n", when,
              c.features, c.map_cells, c.residuals, c.steps, c.memory_mb);
}

// Issue 5: the last tenth within 10 % of the second, and bounded memory. Two kilometres.
TEST(LongDrive, CostsAtItsEndWhatItCostAtItsBeginning) {
  const BeamTable beams = test::even_beams(16, -15.0, 15.0);
  Odometry odometry{OdometryConfig{}};
  Cost second, last;
  int tracked = 0;
  for (int k = 0; k < kScans; ++k) {
    const double at_s = 0.1 * k;
    const Scan scan = test::scan_of(
        road_at(kSpeed_mps * at_s), beams, 600,
        [&](double s) { return on_the_road(at_s + 0.1 * s); }, static_cast<std::uint64_t>(k));
    const Estimate e = odometry.process(scan);
    if (e.status == TrackingStatus::tracking) ++tracked;
    if (k / kTenth == 1) second.add(e);
    if (k / kTenth == 9) last.add(e);
  }
  print("second", second);
  print("last", last);
  EXPECT_GT(tracked, kScans - 20);
  EXPECT_GT(second.features, 500.0);
  EXPECT_NEAR(last.features / second.features, 1.0, 0.1);
  EXPECT_NEAR(last.map_cells / second.map_cells, 1.0, 0.1);
  EXPECT_NEAR(last.residuals / second.residuals, 1.0, 0.1);
  EXPECT_NEAR(last.steps / second.steps, 1.0, 0.1);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_LT(last.memory_mb, second.memory_mb + 2.0);
#endif
}

}  // namespace
}  // namespace lilo
