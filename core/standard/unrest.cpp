#include "core/standard/unrest.hpp"

#include <algorithm>
#include <cmath>

namespace lilo::standard {

void Unrest::learn(const Vector6d& correction, const EndByUnrest& end_by_unrest,
                   const Surprise& surprise) {
  // Steps half and twice as long give nearly the same errors.
  constexpr double kStep = 0.4;     // when both go the same way
  constexpr double kNewest = 0.05;  // of an average over two seconds
  // 55 times the usual density, or a seventh. Calmer than that changes little while it lasts, but
  // holds the first jolt down so far that it is no surprise.
  constexpr double kMost = 4.0, kLeast = -2.0;
  for (int kind = 0; kind < kUnrests; ++kind) {
    Kind& k = kinds_[static_cast<std::size_t>(kind)];
    double correction2 = 0.0, change2 = 0.0, product = 0.0;
    for (int axis = 0; axis < 6; ++axis) {
      if (kUnrestOf[static_cast<std::size_t>(axis)] != kind) continue;
      const double c = correction[axis], by = end_by_unrest(axis, kind);
      correction2 += c * c;
      change2 += by * by;
      product += c * by;
    }
    k.correction2 += kNewest * (correction2 - k.correction2);
    k.change2 += kNewest * (change2 - k.change2);
    // No single scan counts for more than one that agrees in full.
    const double scale =
        std::sqrt(std::max(correction2, k.correction2) * std::max(change2, k.change2));
    if (scale > 0.0) k.log_ratio += kStep * product / scale;
    k.log_ratio += std::log(std::max(1.0, surprise[kind]));
    k.log_ratio = std::clamp(k.log_ratio, kLeast, kMost);
  }
  for (int axis = 0; axis < 6; ++axis) {
    const int kind = kUnrestOf[static_cast<std::size_t>(axis)];
    if (kind < 0) continue;
    density_[axis] = usual_[axis] * std::exp(kinds_[static_cast<std::size_t>(kind)].log_ratio);
  }
}

}  // namespace lilo::standard
