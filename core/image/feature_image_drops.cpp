// SPDX-License-Identifier: BSD-3-Clause
#include "core/image/constants.hpp"
#include "core/image/feature_image.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lilo::core {
namespace {

bool is_near(const Feature& f) {
  return f.x_m * f.x_m + f.y_m * f.y_m < image::kDropRange_m * image::kDropRange_m;
}

}  // namespace

void FeatureImage::count_near(const Feature& f, bool steep) {
  if (f.kind == FeatureKind::ground || !is_near(f)) return;
  ++near_structure_.all;
  if (!steep && is_isolated(f)) ++near_structure_.isolated;
}

bool FeatureImage::is_isolated(const Feature& f) const {
  const float range2 = f.x_m * f.x_m + f.y_m * f.y_m;
  const float nearer = 1.0F - image::kSameRange, farther = 1.0F + image::kSameRange;
  const float least2 = nearer * nearer * range2, most2 = farther * farther * range2;
  const auto rows = static_cast<std::size_t>(beams_.ring_count);
  const std::size_t lowest = f.ring - std::min<std::size_t>(f.ring, 1);
  const std::size_t highest = std::min<std::size_t>(f.ring + 1U, rows - 1);
  const int place = place_of(f.column);
  const int first = std::max(place - beside_, 0), last = std::min(place + beside_, columns_ - 1);
  int neighbours = -1;  // it finds itself
  for (int other = first; other <= last; ++other) {
    const int unwrapped = sweep_.first_column + other;
    const auto column =
        static_cast<std::size_t>(unwrapped < columns_ ? unwrapped : unwrapped - columns_);
    for (std::size_t k = lowest; k <= highest; ++k) {
      if ((filled_[column][k / 64] >> (k % 64) & 1U) == 0) continue;
      const Pixel& p = pixels_[column * rows + k];
      const float other2 = p.x_m * p.x_m + p.y_m * p.y_m;
      neighbours += static_cast<int>((other2 >= least2) & (other2 <= most2));
    }
    if (neighbours >= image::kLeastNeighbours) return false;
  }
  return true;
}

void FeatureImage::leave_out_drops() {
  const auto& [all, isolated] = near_structure_;
  if (isolated <= image::kMostIsolated) return;
  if (static_cast<float>(isolated) <= image::kMostIsolatedPart * static_cast<float>(all)) return;
  std::erase_if(features_, [this](const Feature& f) { return is_near(f) && is_isolated(f); });
}

}  // namespace lilo::core
