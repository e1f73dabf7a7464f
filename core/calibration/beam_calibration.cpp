// SPDX-License-Identifier: BSD-3-Clause
#include "core/calibration/beam_calibration.hpp"

#include "core/constants.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <span>
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

/// Smaller eccentricities are found where there is none, and larger errors no sensor has.
bool is_plausible(double error_rad, double smallest_rad) {
  return std::abs(error_rad) >= smallest_rad && std::abs(error_rad) < calibration::kLargest_rad;
}

/// Part of the information of an observation that the next one leaves.
constexpr double kKept = 1.0 - 1.0 / calibration::kMemory;

/// That of the prior, over weights that are left out of a ratio.
constexpr double kUnweightedPrior = calibration::kPriorInformation / calibration::kWeight;

/// A common error of which nothing is known.
constexpr double kUnknown_rad = 10.0 * calibration::kSigma_rad;
constexpr CommonPrior kUnknown{.variance_rad2 = kUnknown_rad * kUnknown_rad};

/// Near 1 where a ring has seen the ground.
double known_part(double information) {
  return information / (information + calibration::kPriorInformation);
}

/// Of the errors that bend the path the common one is the last (kBeamErrors).
constexpr int kCommon = kBeamErrors - 1;

}  // namespace

void BeamCalibration::resume(const BeamEstimate& kept) {
  if (kept.ring_count == 0) return;
  ring_count_ = kept_ring_count_ = kept.ring_count;
  correction_.elevation_rad = kept.elevation_rad;
  std::transform(kept.elevation_sigma_rad.begin(), kept.elevation_sigma_rad.end(),
                 elevation_information_.begin(), kept_information);
  if (is_plausible(largest_azimuth_rad(kept), calibration::kSmallest_rad)) {
    correction_.eccentricity_rad = {kept.eccentricity_rad[0], kept.eccentricity_rad[1]};
    const double information = kept_information(kept.eccentricity_sigma_rad);
    information_.diagonal().head<2>().setConstant(information);
    sum_.head<2>() = (information + calibration::kPriorInformation) * correction_.eccentricity_rad;
  }
  if (is_plausible(kept.common_elevation_rad, 0.0))
    correction_.common_elevation_rad = kept.common_elevation_rad;
  if (kept.common_by_path_sigma_rad > 0.0) {
    const double believed_rad =
        std::max(kept.common_by_path_sigma_rad, calibration::kKeptSigma_rad);
    information_(kCommon, kCommon) = 1.0 / (believed_rad * believed_rad);
    sum_[kCommon] = information_(kCommon, kCommon) * kept.common_by_path_rad;
  }
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
  // One number for both axes: that of the one seen worse. Nothing is known of an eccentricity that
  // is not applied.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> by_information(
      information_.topLeftCorner<2, 2>());
  const bool is_applied = !correction_.eccentricity_rad.isZero(0.0);
  out.eccentricity_sigma_rad =
      sigma_of(is_applied ? std::max(by_information.eigenvalues()[0], 0.0) : 0.0);
  out.common_elevation_rad = correction_.common_elevation_rad;
  const auto found = found_with(common_prior_);
  out.common_elevation_sigma_rad = found && out.common_elevation_rad != 0.0
                                       ? std::sqrt(found->covariance_rad2(kCommon, kCommon))
                                       : sigma_of(0.0);
  if (const auto seen = found_with(kUnknown)) {
    const double sigma_rad = std::sqrt(seen->covariance_rad2(kCommon, kCommon));
    if (sigma_rad < 0.5 * kUnknown_rad && std::abs(seen->mean_rad[kCommon]) < kUnknown_rad) {
      out.common_by_path_rad = seen->mean_rad[kCommon];
      out.common_by_path_sigma_rad = sigma_rad;
    }
  }
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
  expect_common(beams);
  correct_path();
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
  const auto found = found_with(common_prior_);
  if (!found) return Matrix6d::Zero();
  const Eigen::Vector3d place_m = last_place_m_.value_or(Eigen::Vector3d::Zero());
  const PoseSensitivity::Matrix moved =
      sensitivity_.pose.expressed_at(place_m).moved + rebased_.expressed_at(place_m).moved;
  const Eigen::Matrix<double, 6, kBeamErrors> J = moved.leftCols<kBeamErrors>().cast<double>();
  const Vector6d corrected = moved.col(kBeamErrors).cast<double>();
  const Vector6d uncorrected = J * found->mean_rad - corrected;
  return J * found->covariance_rad2 * J.transpose() + uncorrected * uncorrected.transpose();
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
    return unseen_parts_of(static_cast<double>(beams.elevation_rad[ring]));
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

void BeamCalibration::expect_common(const BeamTable& beams) {
  std::array<RingError, kMaxRings> rings;
  const auto count = static_cast<std::size_t>(beams.ring_count);
  for (std::size_t ring = 0; ring < count; ++ring) {
    rings[ring] = {static_cast<double>(beams.elevation_rad[ring]), correction_.elevation_rad[ring],
                   known_part(elevation_information_[ring])};
  }
  common_prior_ = common_prior(std::span(rings).first(count));
  const auto seen = found_with(kUnknown);
  if (!common_prior_.is_known || !seen) return;
  common_prior_ =
      widened(common_prior_, seen->mean_rad[kCommon], seen->covariance_rad2(kCommon, kCommon));
}

std::optional<BeamCalibration::FoundErrors> BeamCalibration::found_with(
    const CommonPrior& common) const {
  Information prior = calibration::kPriorInformation * Information::Identity();
  prior(kCommon, kCommon) = 1.0 / common.variance_rad2;
  const Eigen::LDLT<Information> of_errors(information_ + prior);
  if (of_errors.info() != Eigen::Success || !of_errors.isPositive()) return std::nullopt;
  Errors sum = sum_;
  sum[kCommon] += prior(kCommon, kCommon) * common.mean_rad;
  return FoundErrors{of_errors.solve(sum), of_errors.solve(Information::Identity())};
}

void BeamCalibration::correct_path() {
  const auto found = found_with(common_prior_);
  if (!found) return;
  const Eigen::Vector2d eccentricity_rad = found->mean_rad.head<2>();
  const bool is_applied = is_plausible(eccentricity_rad.norm(), calibration::kSmallest_rad);
  correction_.eccentricity_rad = is_applied ? eccentricity_rad : Eigen::Vector2d::Zero();
  if (!common_prior_.is_known) return;  // what an earlier run found stays until it is
  const double common_rad = found->mean_rad[kCommon];
  correction_.common_elevation_rad = is_plausible(common_rad, 0.0) ? common_rad : 0.0;
}

}  // namespace lilo::core
