// SPDX-License-Identifier: BSD-3-Clause
#include "core/tracking/pose_uncertainty.hpp"

#include "core/constants.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>

namespace lilo::core {
namespace {

Matrix6d pose_covariance(const MotionState& state) {
  return state.information.inverse().topLeftCorner<6, 6>();
}

/// Without the directions along which a symmetric matrix is negative.
Matrix6d positive_part(const Matrix6d& A) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(A);
  const Matrix6d& V = solver.eigenvectors();
  return V * solver.eigenvalues().cwiseMax(0.0).asDiagonal() * V.transpose();
}

/// Adds motions along the weak directions that are dead reckoned, three at most, each with the
/// square root of its process noise. With so much noise on each axis, a motion has q = 1 / (m'
/// diag(q)^-1 m) along it: a direction that turns far as it moves is as little free as its
/// rotation.
int add_dead_reckoned(std::span<const WeakDirection> weak, const Eigen::Quaterniond& R_odom_sensor,
                      const Vector6d& density, Drift::Motions& motions) {
  int count = 0;
  for (const WeakDirection& one : weak) {
    if (count == 3 || !is_dead_reckoned(one)) continue;
    Vector6d motion;
    motion << R_odom_sensor * one.direction.tail<3>(), R_odom_sensor * one.direction.head<3>();
    const double inverse_density = motion.cwiseAbs2().cwiseQuotient(density).sum();
    motions.col(count++) = motion / std::sqrt(inverse_density);
  }
  return count;
}

/// About no axis is a rotation less known than an angle of which nothing is: pi^2 / 3.
void limit_rotation(Matrix6d& covariance) {
  constexpr double kUnknown_rad2 = std::numbers::pi * std::numbers::pi / 3.0;
  for (int k = 0; k < 3; ++k) {
    const double part = std::min(1.0, std::sqrt(kUnknown_rad2 / covariance(k, k)));
    covariance.row(k) *= part;
    covariance.col(k) *= part;
  }
}

}  // namespace

void PoseUncertainty::begin_map(const MotionState& state) {
  drift_.begin(covariance(state));  // the sensor's axes are the new map's
  last_aligned_.reset();
}

void PoseUncertainty::rewind() {
  drift_.rewind();
  last_aligned_.reset();
}

void PoseUncertainty::predict(const MotionState& state, const Matrix6d& over_gap) {
  if (!last_aligned_) {
    last_aligned_ = {of_alignment(state), pose_covariance(state), Matrix6d::Zero()};
  }
  last_aligned_->over_gaps += over_gap;
}

void PoseUncertainty::learn(const Vector6d& design_effect, const Matrix6d& data_information) {
  last_aligned_.reset();
  data_information_ = data_weight_ * data_information;
  mean_effect_ += tracking::kDesignEffectSmoothing *
                  (design_effect.cwiseMax(tracking::kLeastDesignEffect) - mean_effect_);
  // The mean begins at the least design effect, and would make each early scan an unusual one.
  mean_weight_ += tracking::kDesignEffectSmoothing * (1.0 - mean_weight_);
  const Eigen::Array<bool, 6, 1> is_unusual =
      mean_weight_ * design_effect.array() > tracking::kUnusualDesignEffect * mean_effect_.array();
  design_effect_ = is_unusual.select(design_effect, mean_effect_);
}

/// The first scan is deskewed at the mean velocity from its end to the end of the second one. Under
/// white noise of density q on acceleration, and over scans of T each, its points would be off by a
/// mean error of variance q T^3 (1/20 + 1/12): by how the velocity changes during the first scan
/// and during the second one. But the second scan is aligned with these points, so that the
/// velocity found has the error in it as well, and two thirds of the error are left: 4/9 of 2/15.
void PoseUncertainty::learn_start(const Vector6d& density, double span_s) {
  drift_.set_first_scan((8.0 / 135.0) * span_s * span_s * span_s * density.asDiagonal());
}

void PoseUncertainty::add_keyframe(const MotionState& state, int keyframes) {
  drift_.inherit(of_alignment(state), state.T_odom_sensor.rotation, keyframes, !is_weak_);
}

void PoseUncertainty::learn(const WeakDirections& weak, const MotionState& state,
                            const Vector6d& density, double span_s, bool may_follow_traffic) {
  const std::span all = std::span(weak.all).first(static_cast<std::size_t>(weak.count));
  is_weak_ = !all.empty() && !may_follow_traffic;
  const bool sees_all = std::none_of(all.begin(), all.end(), is_translation);
  const Vector6d shared = mean_by_kind(density);
  Drift::Motions motions = Drift::Motions::Zero();
  int count = add_dead_reckoned(all, state.T_odom_sensor.rotation, shared, motions);
  const bool is_reported = count > 0 && !may_follow_traffic;  // as weak, and by nothing else
  const std::optional<Eigen::Vector3d> degenerate = degenerate_direction(data_information_);
  if (may_follow_traffic) {
    for (const int axis : {3, 4}) motions(axis, count++) = std::sqrt(shared[axis]);
  } else if (degenerate && !is_reported && !sees_all) {
    motions.col(count++).tail<3>() = std::sqrt(shared[3]) * *degenerate;
  }
  if (count > 0) {
    drift_.coast(motions, span_s, !is_reported);
  } else if (sees_all) {
    drift_.see(span_s);
  }
}

/// Against the map, in the odometry's axes. The information comes from the scan and from the prior.
/// The design effect is that of the scan's residuals; the prior counts as it is. So the covariance
/// is the sandwich C (P + S D S) C of the information C^-1 = P + D (Liang and Zeger, 1986).
Matrix6d PoseUncertainty::of_alignment(const MotionState& state) const {
  // The error of a cell is the same for all scans that are matched with it: so many of them count
  // as one. What is the same for longer is for Drift.
  const double unit = tracking::kScansSharingErrors * data_weight_;
  const Vector6d scale = (unit * design_effect_).cwiseSqrt();
  Matrix6d C = pose_covariance(state);
  const Matrix6d information = C.inverse();
  // V' C^-1 V = I, and V' D V is diagonal: the scan's share of each direction. The information of
  // all poses in the scan may be more than that of the pose at its end; then the share is 1.
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> solver(data_information_, information);
  if (solver.info() != Eigen::Success) return C;
  const Vector6d from_scan = solver.eigenvalues().cwiseMax(0.0).cwiseMin(1.0);
  const Matrix6d back = solver.eigenvectors().inverse();
  const Matrix6d D = back.transpose() * from_scan.asDiagonal() * back;
  const Matrix6d P = information - D;
  return C * (P + scale.asDiagonal() * D * scale.asDiagonal()) * C;
}

/// The design effect does not scale what predictions add.
Matrix6d PoseUncertainty::without_drift(const MotionState& state) const {
  if (!last_aligned_) return of_alignment(state);
  return last_aligned_->covariance + last_aligned_->over_gaps +
         positive_part(pose_covariance(state) - last_aligned_->of_state);
}

bool PoseUncertainty::is_uncertain(const MotionState& state) const {
  const Matrix6d recent = drift_.recent() + without_drift(state);
  const double angle_rad2 = recent.topLeftCorner<3, 3>().trace();
  const double distance_m2 = recent.bottomRightCorner<3, 3>().trace();
  const bool is_certain = angle_rad2 <= tracking::kTrusted_rad * tracking::kTrusted_rad &&
                          distance_m2 <= tracking::kTrusted_m * tracking::kTrusted_m;
  return !is_certain;  // nor is what is no number
}

Matrix6d PoseUncertainty::covariance(const MotionState& state) const {
  Matrix6d all = drift_.covariance() + without_drift(state);
  limit_rotation(all);
  return in_sensor_axes(all, state.T_odom_sensor.rotation);
}

}  // namespace lilo::core
