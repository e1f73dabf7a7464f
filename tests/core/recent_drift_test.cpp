// SPDX-License-Identifier: BSD-3-Clause
#include "core/tracking/recent_drift.hpp"

#include <gtest/gtest.h>

namespace lilo::core {
namespace {

TEST(RecentDrift, ForgetsWhatCameMoreThanTenMetresBefore) {
  RecentDrift drift;
  drift.grow(4.0 * Matrix6d::Identity());
  for (int step = 1; step <= 130; ++step) {
    drift.move(Matrix6d::Identity(), 0.1);
    if (step == 60) drift.grow(Matrix6d::Identity());
    if (step > 98 && step < 127) continue;
    const double expected = step < 60 ? 4.0 : step < 99 ? 5.0 : 1.0;
    EXPECT_EQ(drift.covariance()(0, 0), expected) << step;
  }
  drift.clear();
  EXPECT_EQ(drift.covariance(), Matrix6d::Zero());
}

// Scans of 2.4 m: as far as of shorter ones, to a scan.
TEST(RecentDrift, ReachesAsFarBackOfAFastSensor) {
  for (const double scan_m : {0.8, 2.4, 6.0}) {
    RecentDrift drift;
    for (int scan = 0; scan < 100; ++scan) {
      drift.grow(scan_m * Matrix6d::Identity());
      drift.move(Matrix6d::Identity(), scan_m);
      const double way_m = scan_m * (scan + 1);
      if (way_m < 30.0) continue;
      EXPECT_GE(drift.covariance()(0, 0), 10.0 - scan_m) << scan_m;
      EXPECT_LE(drift.covariance()(0, 0), 12.5 + scan_m) << scan_m;
    }
  }
}

// A gap, after which the sensor is far away.
TEST(RecentDrift, ForgetsAllOverALongWay) {
  RecentDrift drift;
  drift.grow(Matrix6d::Identity());
  drift.move(Matrix6d::Identity(), 1000.0);
  EXPECT_EQ(drift.covariance(), Matrix6d::Zero());
  drift.grow(Matrix6d::Identity());
  drift.move(Matrix6d::Identity(), 9.9);
  EXPECT_EQ(drift.covariance()(0, 0), 1.0);
}

// A sensor at rest: half a minute at 10 Hz.
TEST(RecentDrift, ForgetsWhatCameMoreThan300ScansBefore) {
  RecentDrift drift;
  drift.grow(Matrix6d::Identity());
  for (int scan = 1; scan <= 400; ++scan) {
    drift.move(Matrix6d::Identity(), 0.0);
    if (scan > 299 && scan < 375) continue;
    EXPECT_EQ(drift.covariance()(5, 5), scan < 300 ? 1.0 : 0.0) << scan;
  }
}

// An error of yaw moves the sensor sideways as it goes on ahead: by 0.1 rad over 8 m.
TEST(RecentDrift, AnErrorOfAttitudeTurnsIntoOneOfPosition) {
  RecentDrift drift;
  Matrix6d yaw = Matrix6d::Zero();
  yaw(2, 2) = 0.01;
  drift.grow(yaw);
  Matrix6d F = Matrix6d::Identity();
  F(4, 2) = 0.5;  // half a metre ahead
  for (int step = 0; step < 16; ++step) drift.move(F, 0.5);
  EXPECT_NEAR(drift.covariance()(4, 4), 0.64, 1e-12);
  EXPECT_NEAR(drift.covariance()(2, 2), 0.01, 1e-12);
}

}  // namespace
}  // namespace lilo::core
