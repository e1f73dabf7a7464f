// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/trust.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lilo {
namespace {

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
constexpr double kLeastCorrelation = 1e-3;

/// D of the header, since pose `i`.
Pose motion_error(const Matched& poses, std::size_t i, std::size_t j) {
  const Pose estimated = poses.estimate[i].inverse() * poses.estimate[j];
  return estimated.inverse() * (poses.truth[i].inverse() * poses.truth[j]);
}

/// e' P^-1 e; nothing where P is no covariance.
std::optional<double> normalized_square(const Pose& error, const Matrix6d& covariance) {
  const Vector6d variance = covariance.diagonal();
  if (!(variance.minCoeff() > 0.0)) return std::nullopt;
  const Vector6d scale = variance.cwiseSqrt().cwiseInverse();
  const Matrix6d correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(correlation);
  Vector6d e;
  e << error.translation_m, so3_log(error.rotation);
  const Vector6d along = solver.eigenvectors().transpose() * scale.cwiseProduct(e);
  return along.cwiseAbs2().cwiseQuotient(solver.eigenvalues().cwiseMax(kLeastCorrelation)).sum();
}

/// Sums until mean().
struct Mean {
  double sum = 0.0;
  int count = 0;

  void add(double value) {
    sum += value;
    ++count;
  }
  [[nodiscard]] std::optional<double> mean() const {
    return count > 0 ? std::optional(sum / count) : std::nullopt;
  }
};

void add_nees(const PoseStream& estimate, const Matched& matched, Trust& trust) {
  Mean all, tracking;
  for (std::size_t k = 1; k < matched.rows.size(); ++k) {
    const SaidPose& said = estimate.poses[matched.rows[k]];
    if (said.session != 0) break;
    if (!said.covariance) continue;
    if (const auto square = normalized_square(motion_error(matched, 0, k), *said.covariance)) {
      all.add(*square);
      if (said.status == TrackingStatus::tracking) tracking.add(*square);
    }
  }
  trust.nees = all.mean();
  trust.nees_count = all.count;
  trust.nees_tracking = tracking.mean();
}

bool is_wrong(const Pose& error) {
  return error.translation_m.norm() > kFalseTracking_m ||
         so3_log(error.rotation).norm() * kDegreesPerRadian > kFalseTracking_deg;
}

void count_false_tracking(const PoseStream& estimate, const Matched& matched, Trust& trust) {
  const std::vector<double> distance_m = travelled_m(matched.truth);
  const auto said = [&](std::size_t k) -> const SaidPose& {
    return estimate.poses[matched.rows[k]];
  };
  std::size_t session_begin = 0, since = 0, since_tracked = 0;
  for (std::size_t k = 0; k < matched.rows.size(); ++k) {
    if (said(k).session != said(session_begin).session) {
      session_begin = since = since_tracked = k;
    }
    while (since < k && distance_m[k] - distance_m[since + 1] >= kFalseTrackingPath_m) {
      if (said(++since).status == TrackingStatus::tracking) since_tracked = since;
    }
    if (said(k).status != TrackingStatus::tracking) continue;
    const bool wrong = is_wrong(motion_error(matched, since, k)) &&
                       is_wrong(motion_error(matched, since_tracked, k));
    if (wrong) ++trust.false_tracking;
  }
}

}  // namespace

double Trust::false_tracking_percent() const {
  const auto tracking = status_counts[static_cast<std::size_t>(TrackingStatus::tracking)];
  return tracking == 0
             ? 0.0
             : 100.0 * static_cast<double>(false_tracking) / static_cast<double>(tracking);
}

Trust trust(const PoseStream& estimate, const Matched& matched) {
  Trust trust{.sessions = estimate.poses.empty() ? 0 : estimate.poses.back().session + 1};
  for (const SaidPose& said : estimate.poses) {
    ++trust.status_counts[static_cast<std::size_t>(said.status)];
  }
  add_nees(estimate, matched, trust);
  count_false_tracking(estimate, matched, trust);
  return trust;
}

}  // namespace lilo
