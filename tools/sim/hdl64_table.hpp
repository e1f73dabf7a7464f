// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/calibration.hpp"
#include "tools/sim/options.hpp"

#include <cstdint>
#include <vector>

namespace lilo::sim {

/// Corrections of an HDL-64E that could exist: the optics' nominal layout, spread as real units'
/// tables are. Values are whole steps of the status bytes (0.01 degree, 1 mm, focal slope 0.1), so
/// the table in the packets and the one in the files are the same numbers.
/// Without `two_point` the near distance corrections equal the far one.
std::vector<LaserCorrection> make_hdl64_table(Sensor sensor, bool two_point, std::uint64_t seed);

/// The manual's distance correction, raw range to point in the sensor frame (x forward, y left, z
/// up), for a laser at `angle_rad` = azimuth - rotation correction, clockwise. With `two_point` the
/// near corrections apply below 25.04 m (user manual S3, appendix "two-point calibration"); z takes
/// the mean of both, as VeloView does, since the manual's y alone would bend z with the azimuth.
Vec3 hdl64_point(const LaserCorrection& laser, double raw_m, double angle_rad, bool two_point);

}  // namespace lilo::sim
