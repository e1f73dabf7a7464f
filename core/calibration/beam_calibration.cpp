// SPDX-License-Identifier: BSD-3-Clause
#include "core/calibration/beam_calibration.hpp"

#include "core/constants.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <utility>

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

/// Smaller ones are found where there is no error, and larger ones no sensor has.
bool is_plausible(double error_rad, double smallest_rad) {
  return std::abs(error_rad) >= smallest_rad && std::abs(error_rad) < calibration::kLargest_rad;
}

/// Part of the information of an observation that the next one leaves.
constexpr double kKept = 1.0 - 1.0 / calibration::kMemory;

/// That of the prior, over weights that are left out of a ratio.
constexpr double kUnweightedPrior = calibration::kPriorInformation / calibration::kWeight;

/// Near 1 where a ring has seen the ground.
double known_part(double information) {
  return information / (information + calibration::kPriorInformation);
}

Eigen::Matrix3d with_prior(const Eigen::Matrix3d& information) {
  return information + calibration::kPriorInformation * Eigen::Matrix3d::Identity();
}

double common_sigma_rad(const Eigen::Matrix3d& information) {
  const double variance = with_prior(information).inverse()(2, 2);
  return variance > 0.0 ? std::sqrt(variance) : sigma_of(0.0);
}

/// The errors that bend the path, in the order of the columns of a sensitivity.
Eigen::Vector3d errors_of(const BeamCorrection& correction) {
  const Eigen::Vector2d& eccentricity_rad = correction.eccentricity_rad;
  return {eccentricity_rad[0], eccentricity_rad[1], correction.common_elevation_rad};
}

}  // namespace

void BeamCalibration::resume(const BeamEstimate& kept) {
  if (kept.ring_count == 0) return;
  ring_count_ = kept_ring_count_ = kept.ring_count;
  correction_.elevation_rad = kept.elevation_rad;
  std::transform(kept.elevation_sigma_rad.begin(), kept.elevation_sigma_rad.end(),
                 elevation_information_.begin(), kept_information);
  Errors information = Errors::Zero();
  if (is_plausible(largest_azimuth_rad(kept), calibration::kSmallest_rad)) {
    correction_.eccentricity_rad = {kept.eccentricity_rad[0], kept.eccentricity_rad[1]};
    information.head<2>().setConstant(kept_information(kept.eccentricity_sigma_rad));
  }
  if (is_plausible(kept.common_elevation_rad, calibration::kSmallestCommon_rad)) {
    correction_.common_elevation_rad = kept.common_elevation_rad;
    information[2] = kept_information(kept.common_elevation_sigma_rad);
  }
  information_ = information.asDiagonal();
  sum_ = (information.array() + calibration::kPriorInformation) * errors_of(correction_).array();
}

void BeamCalibration::begin_scan(const BeamTable& beams) {
  if (kept_ring_count_ != 0 && kept_ring_count_ != beams.ring_count) *this = {};
  kept_ring_count_ = 0;
  ring_count_ = beams.ring_count;
  for (std::size_t ring = 0; ring < static_cast<std::size_t>(ring_count_); ++ring) {
    correction_.common_part[ring] =
        static_cast<float>(known_part(elevation_information_[ring]) *
                           common_part_of(static_cast<double>(beams.elevation_rad[ring])));
  }
  sensitivity_.correction = correction_;
}

BeamEstimate BeamCalibration::estimate() const {
  BeamEstimate out;
  out.ring_count = ring_count_;
  out.elevation_rad = correction_.elevation_rad;
  std::transform(elevation_information_.begin(), elevation_information_.end(),
                 out.elevation_sigma_rad.begin(), sigma_of);
  out.eccentricity_rad = {correction_.eccentricity_rad[0], correction_.eccentricity_rad[1]};
  // One number for both: that of the direction seen worse. Nothing is known of what is not applied.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> by_information(
      information_.topLeftCorner<2, 2>());
  const bool is_applied = !correction_.eccentricity_rad.isZero(0.0);
  out.eccentricity_sigma_rad =
      sigma_of(is_applied ? std::max(by_information.eigenvalues()[0], 0.0) : 0.0);
  out.common_elevation_rad = correction_.common_elevation_rad;
  out.common_elevation_sigma_rad =
      out.common_elevation_rad != 0.0 ? common_sigma_rad(information_) : sigma_of(0.0);
  return out;
}

bool BeamCalibration::is_due(const Eigen::Vector3d& place_m) const {
  const Eigen::Vector3d last_m = last_place_m_.value_or(Eigen::Vector3d::Zero());
  return (place_m - last_m).norm() > calibration::kApart_m;
}

void BeamCalibration::observe(const BeamEquations& scan, const BeamTable& beams,
                              const Eigen::Vector3d& place_m) {
  last_place_m_ = place_m;
  if (!scan.path.is_finite()) return;
  observe_elevations(scan, beams);
  subtract_unseen(beams);
  observe_path(scan, place_m);
}

std::optional<PoseSensitivity> BeamCalibration::rebase() {
  const float largest_m = sensitivity_.pose.moved.bottomRows<3>().cwiseAbs().maxCoeff();
  if (!(largest_m >= calibration::kRebase_m)) return std::nullopt;
  const PoseSensitivity rebased = std::exchange(sensitivity_.pose, {});
  rebased_ = rebased_.expressed_at(rebased.place_m);
  rebased_.moved += rebased.moved;
  return rebased;
}

Matrix6d BeamCalibration::pose_covariance() const {
  const Eigen::LDLT<Information> of_errors(with_prior(information_));
  if (of_errors.info() != Eigen::Success || !of_errors.isPositive()) return Matrix6d::Zero();
  const Eigen::Vector3d place_m = last_place_m_.value_or(Eigen::Vector3d::Zero());
  const PoseSensitivity::Matrix moved =
      sensitivity_.pose.expressed_at(place_m).moved + rebased_.expressed_at(place_m).moved;
  const Eigen::Matrix<double, 6, kBeamErrors> J = moved.leftCols<kBeamErrors>().cast<double>();
  const Vector6d corrected = moved.col(kBeamErrors).cast<double>();
  const Vector6d uncorrected = J * of_errors.solve(sum_) - corrected;
  return J * of_errors.solve(J.transpose()) + uncorrected * uncorrected.transpose();
}

void BeamCalibration::begin_map() {
  sensitivity_.pose = rebased_ = {};
  last_place_m_.reset();
}

void BeamCalibration::observe_elevations(const BeamEquations& scan, const BeamTable& beams) {
  for (std::size_t ring = 0; ring < static_cast<std::size_t>(beams.ring_count); ++ring) {
    elevation_information_[ring] *= kKept;
    elevation_information_[ring] += calibration::kWeight * scan.rings[ring].information;
    correction_.elevation_rad[ring] +=
        calibration::kWeight * scan.rings[ring].gradient /
        (elevation_information_[ring] + calibration::kPriorInformation);
  }
}

/// Subtracts what the residuals do not show, weighted by information. A ring without information
/// has no part in the fit and keeps its zero.
void BeamCalibration::subtract_unseen(const BeamTable& beams) {
  const auto rings = static_cast<std::size_t>(beams.ring_count);
  Eigen::Matrix2d H = Eigen::Matrix2d::Identity();  // invertible without any information
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  const auto row = [&](std::size_t ring) {
    const auto elevation_rad = static_cast<double>(beams.elevation_rad[ring]);
    return Eigen::Vector2d(common_part_of(elevation_rad), elevation_rad);
  };
  for (std::size_t ring = 0; ring < rings; ++ring) {
    H += elevation_information_[ring] * row(ring) * row(ring).transpose();
    b += elevation_information_[ring] * correction_.elevation_rad[ring] * row(ring);
  }
  const Eigen::Vector2d unseen = H.ldlt().solve(b);
  for (std::size_t ring = 0; ring < rings; ++ring) {
    correction_.elevation_rad[ring] -=
        known_part(elevation_information_[ring]) * row(ring).dot(unseen);
  }
}

/// The pose is eliminated by the Schur complement.
void BeamCalibration::observe_path(const BeamEquations& scan, const Eigen::Vector3d& place_m) {
  const PathEquations& path = scan.path;
  // In a corridor a direction may have no information: 1 sigma of 1 m and 1 rad.
  const Eigen::LDLT<Matrix6d> of_pose(path.pose_information + Matrix6d::Identity());
  const PathEquations::Cross followed = of_pose.solve(path.cross_information);
  if (of_pose.info() != Eigen::Success || !followed.allFinite()) return;
  sensitivity_.pose = sensitivity_.pose.expressed_at(place_m);
  sensitivity_.pose.moved -= followed.cast<float>();
  ErrorEquations of_errors = path.errors;
  of_errors.information -= path.cross_information.transpose() * followed;
  of_errors.gradient -= followed.transpose() * path.pose_gradient;
  leave_out_rings(scan.rings, followed, of_pose.solve(path.pose_gradient), of_errors);
  add_path(of_errors);
  correct_path();
}

/// Takes the ring's mean residual out of every residual: a regression, whose coefficients are those
/// of all scans so far. `followed` and `moved`: how the pose moves with the errors and by itself.
void BeamCalibration::leave_out_rings(const std::array<RingEquations, kMaxRings>& rings,
                                      const PathEquations::Cross& followed, const Vector6d& moved,
                                      ErrorEquations& of_errors) {
  for (std::size_t ring = 0; ring < static_cast<std::size_t>(ring_count_); ++ring) {
    const RingEquations& one = rings[ring];
    const auto by_errors = (one.by_errors - one.by_pose * followed).eval();
    const double gradient = one.gradient - one.by_pose.dot(moved);
    RingMean& mean = ring_means_[ring];
    mean.by_errors = kKept * mean.by_errors + by_errors.head<kBeamErrors>();
    mean.information = kKept * mean.information + one.curvature;
    const auto per_ring = (mean.by_errors / (mean.information + kUnweightedPrior)).eval();
    of_errors.information.topRows<kBeamErrors>() -= per_ring.transpose() * by_errors;
    of_errors.gradient.head<kBeamErrors>() -= per_ring.transpose() * gradient;
  }
}

void BeamCalibration::add_path(const ErrorEquations& errors) {
  const Information H = errors.information.topLeftCorner<kBeamErrors, kBeamErrors>();
  // The last column is what the corrections have done: to add it gives the residuals without them.
  const Errors b =
      errors.gradient.head<kBeamErrors>() + errors.information.topRightCorner<kBeamErrors, 1>();
  information_ = kKept * information_ + calibration::kWeight * 0.5 * (H + H.transpose());
  sum_ = kKept * sum_ + calibration::kWeight * b;
}

void BeamCalibration::correct_path() {
  const Eigen::LDLT<Information> of_errors(with_prior(information_));
  if (of_errors.info() != Eigen::Success || !of_errors.isPositive()) return;
  const Errors found_rad = of_errors.solve(sum_);
  const bool has_eccentricity =
      is_plausible(found_rad.head<2>().norm(), calibration::kSmallest_rad);
  correction_.eccentricity_rad =
      has_eccentricity ? found_rad.head<2>().eval() : Eigen::Vector2d::Zero();
  double& common_rad = correction_.common_elevation_rad;
  const double least_sigmas =
      common_rad == 0.0 ? calibration::kCertainSigmas : calibration::kUncertainSigmas;
  const bool is_certain = std::abs(found_rad[2]) > least_sigmas * common_sigma_rad(information_);
  const bool is_applied =
      is_certain && is_plausible(found_rad[2], calibration::kSmallestCommon_rad);
  common_rad = is_applied ? found_rad[2] : 0.0;
}

}  // namespace lilo::core
