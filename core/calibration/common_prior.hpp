// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/constants.hpp"

#include <Eigen/Core>

#include <span>

/// What the errors of single rings tell of the error that all rings have in common.
namespace lilo::core {

/// Two errors of a ring's elevation that the residuals of its ground do not show: the common one
/// (common_part_of()), and one that grows with the elevation.
[[nodiscard]] Eigen::Vector2d unseen_parts_of(double elevation_rad);

/// The error of one ring as its residuals show it.
struct RingError {
  double elevation_rad = 0.0;
  double found_rad = 0.0;   ///< zero in the mean; without what the residuals do not show
  double known_part = 0.0;  ///< near 1 where the ring has seen the ground; found_rad is this part
};

/// A normal distribution of the common error, before the path tells of it.
struct CommonPrior {
  bool is_known = false;  ///< enough rings have seen the ground
  double mean_rad = 0.0;
  double variance_rad2 = calibration::kSigma_rad * calibration::kSigma_rad;
};

/// The rings err independently, all with the same sigma, but for a small error that they share
/// (kShared_rad). So the most probable common error makes the sum of squares of their whole errors
/// least, and what is left of the sum tells sigma. An approximation of the posterior of a linear
/// regression with an unknown variance (Gelman et al., Bayesian Data Analysis, 3rd edition, section
/// 14.2) by mean and variance; it is exact where every ring is known.
[[nodiscard]] CommonPrior common_prior(std::span<const RingError> rings);

/// `prior`, but wide enough that the common error which the path shows is one sigma of both off at
/// most: its distance from the mean has the sum of both variances as mean square. No wider than
/// where no ring is known. Without this the prior is too narrow for a sensor whose rings are all
/// off by the same angle.
[[nodiscard]] CommonPrior widened(CommonPrior prior, double seen_rad, double seen_variance_rad2);

}  // namespace lilo::core
