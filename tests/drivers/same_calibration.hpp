// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/calibration.hpp"

#include <gtest/gtest.h>

#include <cstddef>

namespace lilo::test {

/// The corrections of the 64 lasers of two calibrations are equal.
inline void expect_same(const Calibration& a, const Calibration& b) {
  for (std::size_t i = 0; i < 64; ++i) {
    const LaserCorrection &x = a.lasers[i], &y = b.lasers[i];
    EXPECT_NEAR(x.rot_rad, y.rot_rad, 1e-9);
    EXPECT_NEAR(x.vert_rad, y.vert_rad, 1e-9);
    EXPECT_NEAR(x.dist_m, y.dist_m, 1e-9);
    EXPECT_NEAR(x.dist_x_m, y.dist_x_m, 1e-9);
    EXPECT_NEAR(x.dist_y_m, y.dist_y_m, 1e-9);
    EXPECT_NEAR(x.vert_offset_m, y.vert_offset_m, 1e-9);
    EXPECT_NEAR(x.horiz_offset_m, y.horiz_offset_m, 1e-9);
    EXPECT_NEAR(x.focal_distance_m, y.focal_distance_m, 1e-9);
    EXPECT_NEAR(x.focal_slope, y.focal_slope, 1e-9);
    EXPECT_EQ(x.min_intensity, y.min_intensity);
    EXPECT_EQ(x.max_intensity, y.max_intensity);
  }
}

}  // namespace lilo::test
