// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/error_track.hpp"

#include <fmt/format.h>

#include <numbers>

namespace lilo {

std::vector<ErrorPoint> error_track(const Matched& poses) {
  const std::vector<double> distance_m = travelled_m(poses.truth);
  const Pose T_start_odom = poses.estimate.front().inverse();
  const Pose T_start_world = poses.truth.front().inverse();
  std::vector<ErrorPoint> track;
  track.reserve(distance_m.size());
  for (std::size_t k = 0; k < distance_m.size(); ++k) {
    const Pose estimate = T_start_odom * poses.estimate[k];
    const Pose truth = T_start_world * poses.truth[k];
    const Pose error = estimate.inverse() * truth;
    track.push_back({distance_m[k], estimate.translation_m, truth.translation_m,
                     error.translation_m.norm(),
                     so3_log(error.rotation).norm() * 180.0 / std::numbers::pi});
  }
  return track;
}

CsvTable error_table(const std::vector<ErrorPoint>& track) {
  CsvTable table{{"distance_m", "x_m", "y_m", "z_m", "true_x_m", "true_y_m", "true_z_m", "error_m",
                  "error_deg"},
                 {}};
  for (const ErrorPoint& p : track) {
    table.rows.emplace_back();
    for (const double value :
         {p.distance_m, p.estimate_m.x(), p.estimate_m.y(), p.estimate_m.z(), p.truth_m.x(),
          p.truth_m.y(), p.truth_m.z(), p.error_m, p.error_deg}) {
      table.rows.back().push_back(fmt::format("{:.4f}", value));
    }
  }
  return table;
}

}  // namespace lilo
