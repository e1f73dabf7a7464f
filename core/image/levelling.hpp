// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/feature.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <vector>

/// Level axes for a sensor that is tilted on its mount, or upside down.
namespace lilo::core {

/// Finds the rotation that turns the normal of the ground around the sensor to z: the smallest one,
/// or if the sensor is upside down, half a turn about its x and then the smallest one. The ground
/// is the plane that more than half of the flat surfaces on one side of the sensor and within
/// image::kNearGround_m are in: found by RANSAC (Fischler and Bolles, Random sample consensus, CACM
/// 1981), then fitted to its points by least squares.
///
/// The side is the lower one of the sensor, unless it sees a plane above that is wider than the
/// ceiling of a room (image::kWidestCeiling_m), and has more than image::kMostCeiling times as many
/// flat surfaces as a floor below (at least tracking::kMinFeatures). Then the sensor is upside
/// down. In rooms either side may be the ground: ceilings count as ground there.
///
/// Not thread-safe; no allocation after construction.
class Levelling {
 public:
  Levelling() { points_m_.reserve(kMostPoints); }
  /// `features`: of one scan, in the sensor's axes. Identity (of an upside-down sensor half a turn
  /// about x) where the tilt is below image::kLeastTilt_rad or above image::kMostTilt_rad. Identity
  /// too where the ground is not seen: fewer than tracking::kMinFeatures flat surfaces, no plane
  /// with more than half of them, or a plane whose points are a strip.
  [[nodiscard]] Eigen::Quaterniond R_level_sensor(const std::vector<Feature>& features);

 private:
  enum class Side { below, above };
  /// Takes the flat surfaces up to a horizontal distance on this side, those above turned over.
  /// Returns how many there are: of many not all are taken.
  double take(const std::vector<Feature>& features, Side side, float most_m);
  /// How many flat surfaces are in a plane that may be a floor; at least tracking::kMinFeatures.
  double count_floor(const std::vector<Feature>& features);

  static constexpr std::size_t kMostPoints = 4096;
  std::vector<Eigen::Vector3d> points_m_;  // evenly of all on one side
};

}  // namespace lilo::core
