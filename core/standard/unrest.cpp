#include "core/standard/unrest.hpp"

#include <algorithm>
#include <cmath>

namespace lilo::standard {
namespace {

// Of the logarithm of the ratio to the usual density: 55 times that, or a seventh. Calmer changes
// little while it lasts, but holds the first jolt down so far that it is no surprise.
constexpr double kMost = 4.0, kLeast = -2.0;

}  // namespace

void Unrest::learn(const Vector6d& correction, const EndByUnrest& end_by_unrest,
                   const PerUnrest& surprise) {
  // Steps half and twice as long give nearly the same errors.
  constexpr double kStep = 0.4;     // when both go the same way
  constexpr double kNewest = 0.05;  // of an average over two seconds
  const EndByUnrest by = unrest_axes().cwiseProduct(end_by_unrest);
  const PerUnrest product = by.transpose() * correction;
  const PerUnrest correction2 = unrest_axes().transpose() * correction.cwiseAbs2();
  const PerUnrest change2 = by.colwise().squaredNorm();
  correction2_ += kNewest * (correction2 - correction2_);
  change2_ += kNewest * (change2 - change2_);
  for (int kind = 0; kind < kUnrests; ++kind) {
    // No single scan counts for more than one that agrees in full.
    const double scale = std::sqrt(std::max(correction2[kind], correction2_[kind]) *
                                   std::max(change2[kind], change2_[kind]));
    if (scale > 0.0) log_ratio_[kind] += kStep * product[kind] / scale;
    log_ratio_[kind] += std::log(std::max(1.0, surprise[kind]));
    log_ratio_[kind] = std::clamp(log_ratio_[kind], kLeast, kMost);
  }
}

Vector6d Unrest::density() const { return density_at(log_ratio_); }

Vector6d Unrest::wildest_density() const { return density_at(PerUnrest::Constant(kMost)); }

Vector6d Unrest::density_at(const PerUnrest& log_ratio) const {
  return usual_.array() * (unrest_axes() * log_ratio).array().exp();
}

}  // namespace lilo::standard
