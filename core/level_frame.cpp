// SPDX-License-Identifier: BSD-3-Clause
#include "core/level_frame.hpp"

#include "core/pose.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

namespace lilo {

BeamTable in_level_axes(const BeamTable& beams, const Eigen::Quaterniond& R_level_sensor) {
  if (!is_upside_down(R_level_sensor)) return beams;
  BeamTable out = beams;
  const auto rings = static_cast<std::size_t>(beams.ring_count);
  for (std::size_t ring = 0; ring < rings; ++ring) {
    out.elevation_rad[ring] = -beams.elevation_rad[rings - 1 - ring];
  }
  return out;
}

BeamEstimate in_level_axes(BeamEstimate beams, const Eigen::Quaterniond& R_level_sensor) {
  if (!is_upside_down(R_level_sensor)) return beams;
  const auto rings = static_cast<std::size_t>(beams.ring_count);
  const std::span elevations_rad = std::span(beams.elevation_rad).first(rings);
  const std::span sigmas_rad = std::span(beams.elevation_sigma_rad).first(rings);
  std::reverse(elevations_rad.begin(), elevations_rad.end());
  std::reverse(sigmas_rad.begin(), sigmas_rad.end());
  for (double& rad : elevations_rad) rad = 0.0 - rad;  // no -0, which would be printed
  for (double* rad :
       {&beams.eccentricity_rad.front(), &beams.common_elevation_rad, &beams.common_by_path_rad}) {
    *rad = 0.0 - *rad;
  }
  return beams;
}

// Half a turn undoes itself.
BeamEstimate in_sensor_axes(const BeamEstimate& beams, const Eigen::Quaterniond& R_level_sensor) {
  return in_level_axes(beams, R_level_sensor);
}

Estimate in_sensor_axes(Estimate estimate, const Eigen::Quaterniond& R_level_sensor) {
  const Eigen::Quaterniond R_sensor_level = R_level_sensor.conjugate();
  const Eigen::Matrix3d turn = R_sensor_level.toRotationMatrix();
  Matrix6d both = Matrix6d::Zero();
  both.topLeftCorner<3, 3>() = both.bottomRightCorner<3, 3>() = turn;
  Pose& T = estimate.T_odom_sensor;
  T = {(R_sensor_level * T.rotation * R_level_sensor).normalized(), turn * T.translation_m};
  estimate.twist.linear_mps = turn * estimate.twist.linear_mps;
  estimate.twist.angular_radps = turn * estimate.twist.angular_radps;
  estimate.covariance = both * estimate.covariance * both.transpose();
  for (WeakDirection& weak : estimate.weak_directions) weak.direction = both * weak.direction;
  return estimate;
}

void turn_to_sensor_axes(const Eigen::Quaterniond& R_level_sensor,
                         std::vector<Eigen::Vector3f>& points_m) {
  const Eigen::Matrix3f turn = R_level_sensor.conjugate().toRotationMatrix().cast<float>();
  for (Eigen::Vector3f& p : points_m) p = turn * p;
}

}  // namespace lilo
