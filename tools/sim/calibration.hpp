// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace lilo::sim {

/// One laser's corrections, in the units and signs of the ROS calibration YAML.
struct LaserCorrection {
  double rotation_rad = 0.0;
  double elevation_rad = 0.0;
  double distance_m = 0.0, distance_x_m = 0.0, distance_y_m = 0.0;
  double vertical_offset_m = 0.0, horizontal_offset_m = 0.0;
  double focal_distance_m = 0.0, focal_slope = 0.0;
  int min_intensity = 0, max_intensity = 255;
};

/// Writes the form that ROS drivers read: lasers by id, then their number and the distance step.
void write_calibration_yaml(const std::string& path, const std::vector<LaserCorrection>& lasers,
                            bool two_point);

/// Writes the form that Velodyne delivers with an HDL-64E (db.xml).
void write_calibration_xml(const std::string& path, const std::vector<LaserCorrection>& lasers);

}  // namespace lilo::sim
