// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/pose.hpp"

#include <Eigen/Geometry>

#include <numbers>

/// How a sensor sits on what carries it: rotations from its axes to those of the carrier.
namespace lilo::test {

inline const Eigen::Quaterniond kUpright = Eigen::Quaterniond::Identity();
inline const Eigen::Quaterniond kNoseDown = so3_exp({0.0, std::numbers::pi / 12.0, 0.0});
inline const Eigen::Quaterniond kUpsideDown = so3_exp({std::numbers::pi, 0.0, 0.0});

}  // namespace lilo::test
