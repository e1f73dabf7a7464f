// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/weak_directions.hpp"

#include "core/constants.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace lilo::core {
namespace {

/// Whether it goes up or down by more than 45 degrees.
bool rises(const Eigen::Vector3d& direction) {
  return std::abs(direction.z()) > direction.head<2>().norm();
}

/// Whether a scan tells far less of a motion, for each metre of it, than of any translation across.
/// Not if it rises, as in degenerate_direction().
bool is_degenerate_along(const Vector6d& motion, const Matrix6d& scan_information) {
  const Eigen::Vector3d along = motion.tail<3>().normalized();
  if (rises(along)) return false;
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - along * along.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> of_translation(
      across * scan_information.bottomRightCorner<3, 3>() * across, Eigen::EigenvaluesOnly);
  const double told = motion.dot(scan_information * motion) / motion.tail<3>().squaredNorm();
  return registration::kDegenerateRatio * told < of_translation.eigenvalues()[1];  // [0] is zero
}

}  // namespace

WeakDirections weak_directions(const Matrix6d& scan_information, const Matrix6d& motion_information,
                               const Eigen::Quaterniond& R_odom_sensor) {
  WeakDirections weak;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> solver(scan_information,
                                                                  motion_information);
  if (solver.info() != Eigen::Success) return weak;
  for (int k = 0; k < kMaxWeakDirections; ++k) {  // eigenvalues grow
    const double ratio = std::max(0.0, solver.eigenvalues()[k]);
    const double from_scan = ratio / (1.0 + ratio);
    if (!(from_scan < registration::kWeakShare)) break;
    const Vector6d along = solver.eigenvectors().col(k).normalized();
    WeakDirection& one = weak.all[static_cast<std::size_t>(weak.count++)];
    one.direction << R_odom_sensor.conjugate() * along.tail<3>(),
        R_odom_sensor.conjugate() * along.head<3>();
    one.from_scan = from_scan;
  }
  return weak;
}

bool is_translation(const WeakDirection& weak) {
  return weak.direction.head<3>().norm() >= registration::kMostlyTurns_m;
}

bool is_dead_reckoned(const WeakDirection& weak) {
  return is_translation(weak) && weak.from_scan < registration::kDeadReckonedShare;
}

bool is_any_dead_reckoned(const WeakDirections& weak) {
  return std::any_of(weak.all.begin(), weak.all.begin() + weak.count, is_dead_reckoned);
}

std::optional<Eigen::Vector3d> degenerate_direction(const Matrix6d& scan_information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> of_translation(
      scan_information.bottomRightCorner<3, 3>());
  const Eigen::Vector3d& growing = of_translation.eigenvalues();
  const Eigen::Vector3d least = of_translation.eigenvectors().col(0);
  const Eigen::Index k = rises(least) ? 1 : 0;
  const bool is_degenerate =
      growing[k + 1] > 0.0 && registration::kDegenerateRatio * growing[k] < growing[k + 1];
  if (!is_degenerate) return std::nullopt;
  return of_translation.eigenvectors().col(k);
}

DeadReckoning::DeadReckoning(const Matrix6d& scan_information, const Matrix6d& motion_information) {
  const WeakDirections weak =
      weak_directions(scan_information, motion_information, Eigen::Quaterniond::Identity());
  const auto all = std::span(weak.all).first(static_cast<std::size_t>(weak.count));
  const auto one = std::find_if(all.begin(), all.end(), is_dead_reckoned);
  if (one == all.end()) return;
  Vector6d motion;
  motion << one->direction.tail<3>(), one->direction.head<3>();
  if (!is_degenerate_along(motion, scan_information)) return;
  motion_ = motion / std::sqrt(motion.dot(motion_information * motion));
  dual_ = motion_information * motion_;
}

void DeadReckoning::hold(const Vector6d& deviation, const Matrix6d& information,
                         Vector6d& gradient) const {
  const double pull = -motion_.dot(information * motion_) * dual_.dot(deviation);
  gradient += (pull - motion_.dot(gradient)) * dual_;
}

}  // namespace lilo::core
