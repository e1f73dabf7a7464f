// SPDX-License-Identifier: BSD-3-Clause
#include "core/constants.hpp"
#include "core/registration/solver.hpp"

#include <algorithm>
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

/// The Cauchy kernel at a residual `r` with information `O`. Along the residual its curvature is
/// less than its weight: with weights the errors would be found too small. A negative one counts
/// as zero.
struct RobustTerms {
  float weight;
  Eigen::Vector3f gradient;
  Eigen::Matrix3f curvature;
};
RobustTerms robust_terms(const Eigen::Vector3f& r, const Eigen::Matrix3f& O, float kernel) {
  const Eigen::Vector3f Or = O * r;
  const float u = r.dot(Or) / (kernel * kernel);
  const float weight = 1.0F / (1.0F + u);
  const float flat = 2.0F * weight / std::max(1.0F + u, 2.0F * u) / (kernel * kernel);
  return {weight, weight * Or, weight * O - flat * Or * Or.transpose()};
}

}  // namespace

BeamEquations Solver::beam_equations(const std::vector<Feature>& features, LocalMaps& maps,
                                     const Trajectory& trajectory,
                                     const ScanSensitivity& sensitivity) {
  BeamEquations sums;
  sample(trajectory, sampled_);
  cached_cells_.assign(features.size(), LocalMaps::kNoCells);
  for (std::size_t k = 0, n = 0; k < features.size(); k += n * calibration::kStride) {
    n = look_up(features, k, calibration::kStride);
    const std::span some = std::span(correspondences_).first(n);
    match(some, maps, Levels::from_whole, Sides::seen);
    for (const Correspondence& one : some) {
      if (one.match.information != nullptr && one.level == LocalMaps::kWhole)
        add_beam_residual(one, maps, sensitivity, sums);
    }
  }
  return sums;
}

void Solver::add_beam_residual(const Correspondence& one, LocalMaps& maps,
                               const ScanSensitivity& sensitivity, BeamEquations& sums) const {
  const Feature& f = *one.feature;
  const bool ground = f.kind == FeatureKind::ground;
  const Eigen::Vector3f& r = one.match.from_mean_m;
  const Eigen::Matrix3f O = matrix_of(*one.match.information);
  const auto [weight, wOr, wO] =
      robust_terms(r, O, ground ? config_.ground_kernel : config_.structure_kernel);
  const Eigen::Matrix<float, 3, 6> J = moved_by_pose(one.turned_m);
  // A rigid motion of the whole path turns the surface of the cell as well. So it counts at the
  // mean of the cell, not at the point.
  const auto cell = maps.at(one.level, f.kind).sensitivity_around(one.cell);
  Sensitivity D = sampled_.turn_columns(f.s, moved_by_beams(f, sensitivity.correction)) +
                  sensitivity.pose.at(cell.mean_m) - cell.sensitivity;
  if (ground) D.topRows<2>().setZero();  // the map has its height alone
  const Eigen::Matrix<float, 3, 6> wOJ = wO * J;
  const Sensitivity wOD = wO * D;
  PathEquations& path = sums.path;
  path.pose_information += (J.transpose() * wOJ).cast<double>();
  path.pose_gradient -= (J.transpose() * wOr).cast<double>();
  path.cross_information += (J.transpose() * wOD).cast<double>();
  path.errors.information += (D.transpose() * wOD).cast<double>();
  path.errors.gradient -= (D.transpose() * wOr).cast<double>();
  if (!ground) return;
  const Eigen::Vector3f up = sampled_.turn(f.s, moved_by_elevation(f));
  RingEquations& ring = sums.rings[f.ring];
  ring.gradient -= static_cast<double>(up.dot(wOr));
  ring.information += static_cast<double>(weight * up.dot(O * up));
  ring.curvature += static_cast<double>(up.dot(wO * up));
  ring.by_pose += (up.transpose() * wOJ).cast<double>();
  ring.by_errors += (up.transpose() * wOD).cast<double>();
}

}  // namespace lilo::core
