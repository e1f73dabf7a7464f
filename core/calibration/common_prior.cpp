// SPDX-License-Identifier: BSD-3-Clause
#include "core/calibration/common_prior.hpp"

#include "core/calibration/beam_correction.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>

namespace lilo::core {
namespace {

/// Six rings that have seen the ground, or five and parts of others.
constexpr double kLeastDegrees = 3.0;

}  // namespace

Eigen::Vector2d unseen_parts_of(double elevation_rad) {
  return {common_part_of(elevation_rad), elevation_rad};
}

CommonPrior common_prior(std::span<const RingError> rings) {
  // A ring with the error kSigma_rad (1 sigma) is found with the variance 1 / known_part, in units
  // of that. Where rings err less, the noise of what is found counts as error.
  Eigen::Matrix2d H = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  double known = 0.0;
  for (const RingError& ring : rings) {
    const Eigen::Vector2d parts = unseen_parts_of(ring.elevation_rad);
    H += ring.known_part * parts * parts.transpose();
    b += ring.found_rad * parts;
    known += ring.known_part;
  }
  CommonPrior prior;
  const double degrees = known - static_cast<double>(b.size());
  // The variance has a mean from two degrees on. Rings that look the same way tell nothing.
  if (degrees < kLeastDegrees || !(H.determinant() > 1e-6 * H(0, 0) * H(1, 1))) return prior;
  const Eigen::LDLT<Eigen::Matrix2d> of_parts(H);
  const Eigen::Vector2d fitted = of_parts.solve(b);
  double squares_rad2 = 0.0;
  for (const RingError& ring : rings) {
    const double left_rad =
        ring.found_rad - ring.known_part * unseen_parts_of(ring.elevation_rad).dot(fitted);
    squares_rad2 += left_rad * left_rad;
  }
  const double variance_rad2 =
      squares_rad2 / (degrees - 2.0) * of_parts.solve(Eigen::Vector2d::UnitX())[0] +
      calibration::kShared_rad * calibration::kShared_rad;
  return {true, -fitted[0], variance_rad2};
}

CommonPrior widened(CommonPrior prior, double seen_rad, double seen_variance_rad2) {
  const double off_rad = seen_rad - prior.mean_rad;
  const double least_rad2 =
      std::min(off_rad * off_rad - seen_variance_rad2, CommonPrior{}.variance_rad2);
  prior.variance_rad2 = std::max(prior.variance_rad2, least_rad2);
  return prior;
}

}  // namespace lilo::core
