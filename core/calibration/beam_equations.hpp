// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/calibration/sensitivity.hpp"
#include "core/pose.hpp"
#include "core/scan.hpp"

#include <Eigen/Core>

#include <array>

/// What the residuals of one scan say of the beams' errors.
namespace lilo::core {

/// Of the errors that bend the path: H and b of H x = b.
struct ErrorEquations {
  Eigen::Matrix<double, kBeamColumns, kBeamColumns> information =
      Eigen::Matrix<double, kBeamColumns, kBeamColumns>::Zero();
  Eigen::Matrix<double, kBeamColumns, 1> gradient = Eigen::Matrix<double, kBeamColumns, 1>::Zero();
};

/// Of a pose and these errors: the blocks of H and b.
struct PathEquations {
  using Cross = Eigen::Matrix<double, 6, kBeamColumns>;
  Matrix6d pose_information = Matrix6d::Zero();
  Cross cross_information = Cross::Zero();
  Vector6d pose_gradient = Vector6d::Zero();
  ErrorEquations errors;

  [[nodiscard]] bool is_finite() const {
    return pose_information.allFinite() && cross_information.allFinite() &&
           pose_gradient.allFinite() && errors.information.allFinite() &&
           errors.gradient.allFinite();
  }
};

/// The elevation of one ring, from its ground at the pose of the alignment: gradient, information
/// by robust weights and by the curvature of the kernel, and the blocks of H that join it with pose
/// and errors.
struct RingEquations {
  double gradient = 0.0, information = 0.0, curvature = 0.0;
  Eigen::Matrix<double, 1, 6> by_pose = Eigen::Matrix<double, 1, 6>::Zero();
  Eigen::Matrix<double, 1, kBeamColumns> by_errors = Eigen::Matrix<double, 1, kBeamColumns>::Zero();
};

struct BeamEquations {
  std::array<RingEquations, kMaxRings> rings{};
  PathEquations path;
};

}  // namespace lilo::core
