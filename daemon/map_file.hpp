// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/pose.hpp"

#include <string>
#include <vector>

namespace lilo {

/// The points as a binary PCD file, version 0.7 (PCL's "The PCD file format"), moved by `T`.
/// Written by hand because PCL's writer would bring VTK onto the robot.
std::string to_pcd(const std::vector<Eigen::Vector3f>& points_m, const Pose& T);

}  // namespace lilo
