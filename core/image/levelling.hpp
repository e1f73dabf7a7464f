// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/feature.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <vector>

/// Level axes for a sensor that is tilted on its mount.
namespace lilo::core {

/// Finds the smallest rotation that turns the normal of the ground around the sensor to z. The
/// ground is the plane that more than half of the flat surfaces below the sensor and within
/// image::kNearGround_m are in: found by RANSAC (Fischler and Bolles, Random sample consensus, CACM
/// 1981), then fitted to its points by least squares. Not thread-safe; no allocation after
/// construction.
class Levelling {
 public:
  Levelling() { points_m_.reserve(kMostPoints); }
  /// `features`: of one scan, in the sensor's axes. Identity where the tilt is below
  /// image::kLeastTilt_rad or above image::kMostTilt_rad, and where the ground is not seen: fewer
  /// than tracking::kMinFeatures flat surfaces, no plane with more than half of them, or a plane
  /// whose points are a strip.
  [[nodiscard]] Eigen::Quaterniond R_level_sensor(const std::vector<Feature>& features);

 private:
  static constexpr std::size_t kMostPoints = 4096;
  std::vector<Eigen::Vector3d> points_m_;  // evenly of all that are flat and near
};

}  // namespace lilo::core
