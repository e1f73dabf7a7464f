// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/odometry_config.hpp"
#include "core/scan.hpp"
#include "tools/plot/canvas.hpp"

#include <string>

namespace lilo {

/// What profile paper makes of one scan: the spherical range image and its edge, surface and ground
/// parts (Eqs. 8-10; the paper's Figure 3), and the same features in 3-D, from straight above and
/// from above behind, in the paper's colours: edges red, surfaces blue, ground green. Azimuth and
/// rows as in draw(scan).
Canvas draw_features(const Scan& scan, const OdometryConfig& config, const std::string& title);

/// Where a point of the sensor's frame lies in a picture of parallel projection: the viewer looks
/// down by `elevation_rad` (pi/2: straight down) along +x. {to the right, up}, in metres; x is up
/// in the picture, y to the left.
Eigen::Vector2d seen_from_above(const Eigen::Vector3d& p, double elevation_rad);

}  // namespace lilo
