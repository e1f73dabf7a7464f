// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <cstdint>
#include <vector>

namespace lilo {

enum class FeatureKind : std::uint8_t {
  ground,     ///< on a flat slope: the ground, or a ceiling overhead
  structure,  ///< everything else: walls, poles, trunks, foliage
};

/// A return of the image, and the gap to the next sample of its surface.
struct Feature {
  float x_m, y_m, z_m;  ///< from the sensor at the firing, in the axes of ScanFeatures
  float s;              ///< that instant as a part of the scan's duration, in [0, 1]
  /// The gap: vector to the nearer one of the neighbouring rings' returns on the same surface.
  /// Where these are far apart, it goes along the tangent to the parabola through three rings.
  /// Where neither ring hits the surface, the vector goes across the ray and upright, as far as the
  /// next ring of a level sensor would look. The height of a bar that one ring hits is unknown, and
  /// so is rough ground between rings far apart.
  float dx_m, dy_m, dz_m;
  FeatureKind kind;
  std::uint8_t ring;         ///< 0: of the lowest beam, however the sensor is mounted
  std::uint16_t column = 0;  ///< of the range image
};

/// Whether it is on a flat surface overhead: a ceiling in a room; elsewhere a bridge, a roof or,
/// mostly, a canopy.
inline bool is_overhead(const Feature& f) { return f.kind == FeatureKind::ground && f.z_m >= 0.0F; }

/// The features of a scan, which the odometry takes instead of all returns. The memory is reused.
struct ScanFeatures {
  std::vector<Feature> all;  ///< profile paper: none, it takes the scan
  /// From the sensor's axes to those of the features. Of a levelled sensor their z is the normal of
  /// the ground in the scan that told the tilt (FeatureExtractor). Identity where it is not
  /// levelled.
  Eigen::Quaterniond R_level_sensor = Eigen::Quaterniond::Identity();
};

}  // namespace lilo
