// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/calibration.hpp"

#include "tools/sim/text_out.hpp"

#include <fmt/format.h>

namespace lilo::sim {

void write_calibration_yaml(const std::string& path, const std::vector<LaserCorrection>& lasers,
                            bool two_point) {
  std::string text = "lasers:\n";
  for (std::size_t id = 0; id < lasers.size(); ++id) {
    const LaserCorrection& c = lasers[id];
    text += fmt::format(
        "- dist_correction: {:.6g}\n  dist_correction_x: {:.6g}\n  dist_correction_y: {:.6g}\n"
        "  focal_distance: {:.6g}\n  focal_slope: {:.6g}\n  horiz_offset_correction: {:.6g}\n"
        "  laser_id: {}\n  max_intensity: {}\n  min_intensity: {}\n  rot_correction: {:.12g}\n"
        "  two_pt_correction_available: {}\n  vert_correction: {:.12g}\n"
        "  vert_offset_correction: {:.6g}\n",
        c.distance_m, c.distance_x_m, c.distance_y_m, c.focal_distance_m, c.focal_slope,
        c.horizontal_offset_m, id, c.max_intensity, c.min_intensity, c.rotation_rad, two_point,
        c.elevation_rad, c.vertical_offset_m);
  }
  text += fmt::format("num_lasers: {}\ndistance_resolution: 0.002\n", lasers.size());
  write_text(path, text);
}

}  // namespace lilo::sim
