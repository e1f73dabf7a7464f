// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/motion/motion_state.hpp"
#include "core/registration/weak_directions.hpp"

#include <Eigen/Geometry>

#include <numbers>

/// States and scans of which it is known how uncertain they are.
namespace lilo::core {

// A scan counts its residuals by this weight, and three scans share the error of a cell: the
// variance by independent residuals counts 0.3 times for each unit of the design effect.
inline constexpr double kDataWeight = 0.1, kUnit = 3.0 * kDataWeight;
inline constexpr double kLeastDesignEffect = 0.05;
inline constexpr double kScan_s = 0.1;
inline constexpr int kOldMap = 100;  // keyframes: each is a thirteenth of what is seen

inline const Eigen::Quaterniond kLeft(Eigen::AngleAxisd(std::numbers::pi / 2,
                                                        Eigen::Vector3d::UnitZ()));

/// A scan that tells the whole pose.
inline const Matrix6d kAllFromScan = 1e12 * Matrix6d::Identity();

/// A state whose pose has these variances by its information (rotation, translation).
inline MotionState state_of(const Vector6d& variance) {
  MotionState state;
  state.information = KnotInformation::Identity();
  state.information.topLeftCorner<6, 6>().diagonal() = variance.cwiseInverse();
  return state;
}

inline MotionState exact_state() { return state_of(Vector6d::Constant(1e-18)); }

inline Vector6d six(double rx, double ry, double rz, double x, double y, double z) {
  Vector6d v;
  v << rx, ry, rz, x, y, z;
  return v;
}

/// A direction, translation first, of which a scan says nothing.
inline WeakDirections weak_along(const Vector6d& direction) {
  WeakDirections weak;
  weak.count = 1;
  weak.all[0].direction = direction;
  return weak;
}

}  // namespace lilo::core
