#pragma once

#include "core/odometry_config.hpp"
#include "core/paper/local_map.hpp"

namespace lilo::paper {

/// A straight line or a plane fitted to map points: a point of it and its direction or normal.
struct Primitive {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  bool valid = false;
};

/// Section 4: the line through map points is the eigenvector of the largest eigenvalue of their
/// covariance. Valid for at least five points whose largest eigenvalue is over 3 times the second
/// (LOAM's test).
Primitive fit_line(const Cloud& map, const std::vector<int>& indices);

/// Section 4: the plane's normal is the eigenvector of the smallest eigenvalue. Valid for at least
/// five points that spread in two directions and stay within 10 cm (1 sigma) of the plane.
Primitive fit_plane(const Cloud& map, const std::vector<int>& indices);

/// Distance of a point from a line as a vector across it (its norm is f_E of Eq. 22), and its
/// derivative by a step (rotation about the sensor along the odometry axes, translation). Turning
/// about the sensor and not the odometry's origin keeps the normal equation well conditioned far
/// from home.
struct LineResidual {
  Eigen::Vector3d value;
  Eigen::Matrix<double, 3, 6> jacobian;
};
LineResidual line_residual(const Pose& T, const Eigen::Vector3d& p, const Primitive& line);

/// f_S of Eq. 23 and its derivative.
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

/// Eq. 21: T* = argmin sum f_E^2 + sum f_S^2 by Gauss-Newton from `guess`, Huber weights,
/// correspondences within `search_m`. The paper is silent on how often they are sought: here again
/// when a step has moved the feature by 15 % of `search_m`, over which a neighbourhood hardly
/// changes.
Alignment align(const Cloud& edges, const Cloud& surfaces, const LocalMap& edge_map,
                const LocalMap& surface_map, const Pose& guess, double search_m,
                const PaperConfig& config);

}  // namespace lilo::paper
