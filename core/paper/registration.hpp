// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/odometry_config.hpp"
#include "core/paper/local_map.hpp"

#include <cstdint>

namespace lilo::paper {

/// A straight line or a plane fitted to map points: a point of it (P^l of Eqs. 21 and 23, here
/// their mean; the print is silent) and its direction n^l_E or normal n^l_S.
struct Primitive {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  bool valid = false;
};

/// n^l_E of Eq. 21: the line through map points runs along the eigenvector of the largest
/// eigenvalue of their covariance (the print calls n^l_E an eigenvalue). Valid for at least five
/// points whose largest eigenvalue is over 3 times the second (LOAM's test; the paper is silent).
Primitive fit_line(const Cloud& map, const std::vector<int>& indices);

/// n^l_S of Eq. 23: the plane's normal is the eigenvector of the smallest eigenvalue. Valid for at
/// least five points that spread in two directions and stay within 10 cm (1 sigma) of the plane
/// (our choice; the paper is silent).
Primitive fit_plane(const Cloud& map, const std::vector<int>& indices);

/// Eqs. 21 and 22: the part of a point's offset across the line. It is as long as the offset's
/// cross product with n^l_E, so its norm is f_E. And its derivative by a step (rotation about the
/// sensor along the odometry axes, translation). Turning about the sensor and not the odometry's
/// origin keeps the normal equation well conditioned far from home.
struct LineResidual {
  Eigen::Vector3d value;
  Eigen::Matrix<double, 3, 6> jacobian;
};
LineResidual line_residual(const Pose& T, const Eigen::Vector3d& p, const Primitive& line);

/// f_S of Eq. 23, with its sign, and its derivative. What the print adds, P_S + P_G, are two sets
/// of points taken together.
struct PlaneResidual {
  double value;
  Eigen::Matrix<double, 1, 6> jacobian;
};
PlaneResidual plane_residual(const Pose& T, const Eigen::Vector3d& p, const Primitive& plane);

struct Alignment {
  Pose T_odom_sensor;
  Matrix6d information = Matrix6d::Zero();  ///< of the step (rotation, translation)
  int correspondences = 0;
  int iterations = 0;
  double residual_rms_m = 0.0;
  bool converged = false;
};

/// Eq. 20: T* = argmin sum f_E^2 + sum f_S^2 by Gauss-Newton from `guess`, correspondences within
/// `search_m`. The print sums distances, which Gauss-Newton cannot minimise: here their squares,
/// under Huber's weights. It is silent on how often correspondences are sought: here again when a
/// step has moved the feature by `search_again` of `search_m`. It ends unconverged when it has seen
/// so many neighbours that `neighbours_left`, from which they are taken, is not above zero.
Alignment align(const Cloud& edges, const Cloud& surfaces, const LocalMap& edge_map,
                const LocalMap& surface_map, const Pose& guess, double search_m,
                const PaperConfig& config, std::int64_t& neighbours_left);

}  // namespace lilo::paper
