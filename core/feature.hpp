// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace lilo {

enum class FeatureKind : std::uint8_t {
  ground,     ///< flat towards the next ring: the ground, and overhead a ceiling
  structure,  ///< everything that stands: walls, poles, trunks, foliage
};

/// A return that a pixel of the image kept, and how far its surface reaches unseen.
struct Feature {
  float x_m, y_m, z_m;  ///< sensor frame at the instant of the firing
  float s;              ///< that instant as a part of the scan's duration, in [0, 1]
  /// To the nearer of the neighbouring rings' returns on the same surface. Where there is none, as
  /// far up as the next ring looks: how high a bar is that one ring hits, nobody knows, nor how the
  /// ground runs where rings are far apart.
  float dx_m, dy_m, dz_m;
  FeatureKind kind;
  std::uint8_t ring;
};

/// Of a ceiling, if in a room; elsewhere of a bridge, a roof or, mostly, a canopy.
inline bool is_overhead(const Feature& f) { return f.kind == FeatureKind::ground && f.z_m >= 0.0F; }

/// What the odometry looks at instead of all returns of a scan. Its memory is reused.
struct ScanFeatures {
  std::vector<Feature> all;  ///< profile paper: none, it takes the scan
};

}  // namespace lilo
