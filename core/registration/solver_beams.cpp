// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/solver.hpp"

#include <span>

namespace lilo::core {
namespace {

/// How a point `p` from the sensor moves by rotation and translation (odometry axes).
Eigen::Matrix<float, 3, 6> moved_by_pose(const Eigen::Vector3f& p) {
  Eigen::Matrix<float, 3, 6> J;
  J << 0.0F, p.z(), -p.y(), 1.0F, 0.0F, 0.0F,  //
      -p.z(), 0.0F, p.x(), 0.0F, 1.0F, 0.0F,   //
      p.y(), -p.x(), 0.0F, 0.0F, 0.0F, 1.0F;
  return J;
}

}  // namespace

BeamEquations Solver::beam_equations(const std::vector<Feature>& features, LocalMaps& maps,
                                     const Trajectory& trajectory) {
  BeamEquations sums;
  sample(trajectory, sampled_);
  cached_cells_.assign(features.size(), LocalMaps::kNoCells);
  for (std::size_t k = 0, n = 0; k < features.size(); k += n * calibration::kStride) {
    n = look_up(features, k, calibration::kStride);
    const std::span some = std::span(correspondences_).first(n);
    match(some, maps, Levels::from_whole, Sides::seen);
    for (const Correspondence& one : some) {
      if (one.match.information != nullptr) add_beam_residual(one, maps, sums);
    }
  }
  return sums;
}

void Solver::add_beam_residual(const Correspondence& one, LocalMaps& maps,
                               BeamEquations& sums) const {
  const Feature& f = *one.feature;
  const bool ground = f.kind == FeatureKind::ground;
  const Eigen::Vector3f& r = one.match.from_mean_m;
  const Eigen::Matrix3f O = matrix_of(*one.match.information);
  const float kernel = ground ? config_.ground_kernel : config_.structure_kernel;
  const float robust = 1.0F / (1.0F + r.dot(O * r) / (kernel * kernel));
  const Eigen::Matrix3f wO = robust * O;
  const Eigen::Vector3f wOr = wO * r;
  if (ground) {
    const Eigen::Vector3f up = sampled_.turn(f.s, moved_by_elevation(f));
    sums.elevation_gradient[f.ring] -= static_cast<double>(up.dot(wOr));
    sums.elevation_information[f.ring] += static_cast<double>(up.dot(wO * up));
  }
  // Only whole cells have sensitivities.
  if (one.level != LocalMaps::kWhole) return;
  const Eigen::Matrix<float, 3, 6> J = moved_by_pose(one.turned_m);
  sums.pose_information += (J.transpose() * wO * J).cast<double>();
  sums.pose_gradient -= (J.transpose() * wOr).cast<double>();
  if (ground) return;  // as in make_cells(): it does not show the eccentricity
  const Sensitivity by_cell = maps.at(LocalMaps::kWhole, f.kind).sensitivity_around(one.cell);
  const Sensitivity D = sampled_.turn_columns(f.s, moved_by_eccentricity(f)) - by_cell;
  sums.cross_information += (J.transpose() * wO * D).cast<double>();
  sums.eccentricity_information += (D.transpose() * wO * D).cast<double>();
  sums.eccentricity_gradient -= (D.transpose() * wOr).cast<double>();
}

}  // namespace lilo::core
