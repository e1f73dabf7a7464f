// SPDX-License-Identifier: BSD-3-Clause
#include "core/calibration/beam_correction.hpp"

namespace lilo::core {

void BeamCorrection::apply(std::vector<Feature>& features) const {
  const Eigen::Vector2f eccentricity = eccentricity_rad.cast<float>();
  std::array<float, kMaxRings> by_ring_rad;
  for (std::size_t ring = 0; ring < by_ring_rad.size(); ++ring) {
    by_ring_rad[ring] = static_cast<float>(
        elevation_rad[ring] + static_cast<double>(common_part[ring]) * common_elevation_rad);
  }
  for (Feature& f : features) {
    const float horizontal_m = std::sqrt(f.x_m * f.x_m + f.y_m * f.y_m);
    if (!(horizontal_m > 0.0F)) continue;
    const float cosine = f.x_m / horizontal_m, sine = f.y_m / horizontal_m;
    const float up_rad = by_ring_rad[f.ring];
    const float around_rad = eccentricity[0] * cosine + eccentricity[1] * sine;
    const float x_m = f.x_m, y_m = f.y_m;
    f.x_m -= around_rad * y_m + up_rad * f.z_m * cosine;
    f.y_m += around_rad * x_m - up_rad * f.z_m * sine;
    f.z_m += up_rad * horizontal_m;
  }
}

}  // namespace lilo::core
