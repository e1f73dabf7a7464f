// SPDX-License-Identifier: BSD-3-Clause
#include "core/calibration/beam_calibration.hpp"

#include "core/constants.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace lilo::core {
namespace {

double sigma_of(double information) {
  return 1.0 / std::sqrt(information + calibration::kPriorInformation);
}

/// Without the information of the prior, and no more than kKeptSigma_rad has.
double kept_information(double sigma_rad) {
  const double believed_rad = std::max(sigma_rad, calibration::kKeptSigma_rad);
  return std::max(0.0, 1.0 / (believed_rad * believed_rad) - calibration::kPriorInformation);
}

/// Smaller ones are those of exact encoders, and larger ones no encoder's.
bool is_applied(double eccentricity_rad) {
  return eccentricity_rad >= calibration::kSmallest_rad &&
         eccentricity_rad < calibration::kLargest_rad;
}

}  // namespace

void BeamCalibration::resume(const BeamEstimate& kept) {
  if (kept.ring_count == 0) return;
  ring_count_ = kept_ring_count_ = kept.ring_count;
  correction_.elevation_rad = kept.elevation_rad;
  std::transform(kept.elevation_sigma_rad.begin(), kept.elevation_sigma_rad.end(),
                 elevation_information_.begin(), kept_information);
  if (!is_applied(largest_azimuth_rad(kept))) return;
  correction_.eccentricity_rad = {kept.eccentricity_rad[0], kept.eccentricity_rad[1]};
  const double information = kept_information(kept.eccentricity_sigma_rad);
  eccentricity_information_ = information * Eigen::Matrix2d::Identity();
  eccentricity_sum_ = (information + calibration::kPriorInformation) * correction_.eccentricity_rad;
}

void BeamCalibration::begin_scan(const BeamTable& beams) {
  if (kept_ring_count_ != 0 && kept_ring_count_ != beams.ring_count) *this = {};
  kept_ring_count_ = 0;
  ring_count_ = beams.ring_count;
}

BeamEstimate BeamCalibration::estimate() const {
  BeamEstimate out;
  out.ring_count = ring_count_;
  out.elevation_rad = correction_.elevation_rad;
  std::transform(elevation_information_.begin(), elevation_information_.end(),
                 out.elevation_sigma_rad.begin(), sigma_of);
  out.eccentricity_rad = {correction_.eccentricity_rad[0], correction_.eccentricity_rad[1]};
  // One number for both: that of the direction seen worse. Nothing is known of what is not applied.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> by_information(eccentricity_information_);
  const bool is_applied = !correction_.eccentricity_rad.isZero(0.0);
  out.eccentricity_sigma_rad =
      sigma_of(is_applied ? std::max(by_information.eigenvalues()[0], 0.0) : 0.0);
  return out;
}

bool BeamCalibration::is_due(const Eigen::Vector3d& place_m) const {
  return !last_place_m_ || (place_m - *last_place_m_).norm() > calibration::kApart_m;
}

void BeamCalibration::observe(const BeamEquations& scan, const BeamTable& beams,
                              const Eigen::Vector3d& place_m) {
  last_place_m_ = place_m;
  observe_elevations(scan, beams);
  subtract_common_line(beams);
  observe_eccentricity(scan);
}

void BeamCalibration::begin_map() {
  sensitivity_.setZero();
  last_place_m_.reset();
}

void BeamCalibration::observe_elevations(const BeamEquations& scan, const BeamTable& beams) {
  for (std::size_t ring = 0; ring < static_cast<std::size_t>(beams.ring_count); ++ring) {
    elevation_information_[ring] *= 1.0 - 1.0 / calibration::kMemory;
    elevation_information_[ring] += calibration::kWeight * scan.elevation_information[ring];
    correction_.elevation_rad[ring] +=
        calibration::kWeight * scan.elevation_gradient[ring] /
        (elevation_information_[ring] + calibration::kPriorInformation);
  }
}

/// Subtracts a line fitted over the elevations, weighted by information. A ring without information
/// has no part in the fit and keeps its zero.
void BeamCalibration::subtract_common_line(const BeamTable& beams) {
  const auto rings = static_cast<std::size_t>(beams.ring_count);
  Eigen::Matrix2d H = Eigen::Matrix2d::Identity();  // invertible without any information
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  const auto row = [&](std::size_t ring) {
    return Eigen::Vector2d(1.0, static_cast<double>(beams.elevation_rad[ring]));
  };
  for (std::size_t ring = 0; ring < rings; ++ring) {
    H += elevation_information_[ring] * row(ring) * row(ring).transpose();
    b += elevation_information_[ring] * correction_.elevation_rad[ring] * row(ring);
  }
  const Eigen::Vector2d common = H.ldlt().solve(b);
  for (std::size_t ring = 0; ring < rings; ++ring) {
    const double known = elevation_information_[ring] /
                         (elevation_information_[ring] + calibration::kPriorInformation);
    correction_.elevation_rad[ring] -= known * row(ring).dot(common);
  }
}

/// The pose is eliminated by the Schur complement.
void BeamCalibration::observe_eccentricity(const BeamEquations& scan) {
  // In a corridor a direction may have no information: 1 sigma of 1 m and 1 rad.
  const Eigen::LDLT<Matrix6d> of_pose(scan.pose_information + Matrix6d::Identity());
  const PoseSensitivity followed = of_pose.solve(scan.cross_information);
  if (of_pose.info() != Eigen::Success || !followed.allFinite()) return;
  sensitivity_ = -followed;
  const Eigen::Matrix2d H =
      scan.eccentricity_information - scan.cross_information.transpose() * followed;
  const Eigen::Vector2d b = scan.eccentricity_gradient - followed.transpose() * scan.pose_gradient;
  const double kept = 1.0 - 1.0 / calibration::kMemory;
  eccentricity_information_ = kept * eccentricity_information_ + calibration::kWeight * H;
  eccentricity_sum_ =
      kept * eccentricity_sum_ + calibration::kWeight * (b + H * correction_.eccentricity_rad);
  const Eigen::Matrix2d all =
      eccentricity_information_ + calibration::kPriorInformation * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d found_rad = all.ldlt().solve(eccentricity_sum_);
  const bool applies = is_applied(found_rad.norm());
  correction_.eccentricity_rad = applies ? found_rad : Eigen::Vector2d::Zero();
}

}  // namespace lilo::core
