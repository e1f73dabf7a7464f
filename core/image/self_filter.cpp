// SPDX-License-Identifier: BSD-3-Clause
#include "core/image/self_filter.hpp"

#include "core/image/constants.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace lilo::core {
namespace {

constexpr float kNear_m = 2.0F * image::kSelfRange_m;  // where a surface goes on beyond the range

float range2_m2(const Feature& f) { return f.x_m * f.x_m + f.y_m * f.y_m + f.z_m * f.z_m; }
float range_m(const Feature& f) { return std::sqrt(range2_m2(f)); }

/// Whether two neighbours in the image are on one surface. Rings may meet level ground far apart.
bool are_one_surface(const Feature& a, const Feature& b) {
  const float dx_m = a.x_m - b.x_m, dy_m = a.y_m - b.y_m, dz_m = a.z_m - b.z_m;
  const float farther_m = std::max(range_m(a), range_m(b));
  const float most_m = std::max(image::kSurfaceGap_m, image::kSurfaceGapPart * farther_m);
  if (dx_m * dx_m + dy_m * dy_m + dz_m * dz_m < most_m * most_m) return true;
  const bool are_ground = a.kind == FeatureKind::ground && b.kind == FeatureKind::ground;
  return are_ground && std::abs(dz_m) < image::kGroundStep_m;
}

/// Memory that is touched, so that no scan takes page faults.
template <typename T>
void reserve_touched(std::vector<T>& items, std::size_t count) {
  items.resize(count);
  items.clear();
}

}  // namespace

void SelfFilter::filter(std::vector<Feature>& features, const std::vector<Feature>& too_near,
                        ImageSize size) {
  if (size != size_) begin(size);
  ++scans_;
  near_.clear();
  note(features);
  near_features_ = near_.size();
  note(too_near);
  if (scans_ % search_period() == 0) find_robot(features);
  if (!robot_.empty()) std::erase_if(features, [this](const Feature& f) { return is_self(f); });
}

void SelfFilter::begin(ImageSize size) {
  const auto pixels = static_cast<std::size_t>(size.columns) * static_cast<std::size_t>(size.rings);
  size_ = size;
  scans_ = 0;
  seen_.assign(pixels, {});
  self_m_.assign(pixels, 0.0F);
  at_.assign(pixels, -1);
  reserve_touched(near_, pixels);
  for (auto* some : {&region_, &members_, &found_, &robot_}) reserve_touched(*some, pixels);
}

int SelfFilter::search_period() const {
  if (scans_ <= image::kSteadyScans) return 3;
  return robot_.empty() ? 5 : 10;
}

std::size_t SelfFilter::pixel_at(int column, int ring) const {
  return static_cast<std::size_t>(column) * static_cast<std::size_t>(size_.rings) +
         static_cast<std::size_t>(ring);
}

void SelfFilter::note(const std::vector<Feature>& returns) {
  for (const Feature& f : returns) {
    Seen& seen = seen_[pixel_at(f.column, f.ring)];
    if (seen.last == scans_) continue;  // a feature, and a return that is too near
    seen.last = scans_;
    const float range = range_m(f);
    note(range, seen);
    if (range < kNear_m) near_.push_back(f);
  }
}

void SelfFilter::note(float range_m, Seen& seen) {
  constexpr int kLost = 3;  // scans: a robot is gained while less than a quarter is drops
  if (std::abs(range_m - seen.range_m) < image::kSteadyRange_m) {
    seen.scans = std::min(seen.scans + 1, image::kSteadyScans);
  } else if (seen.scans > kLost) {
    seen.scans -= kLost;
  } else {
    seen.range_m = range_m;
    seen.scans = 1;
  }
}

void SelfFilter::find_robot(const std::vector<Feature>& features) {
  std::fill(at_.begin(), at_.end(), -1);
  for (std::size_t k = 0; k < near_.size(); ++k) {
    at_[pixel_at(near_[k].column, near_[k].ring)] = static_cast<std::int32_t>(k);
  }
  Structure other;
  for (const Feature& f : features) count(f, 1, other);
  found_.clear();
  for (std::size_t pixel = 0; pixel < at_.size(); ++pixel) {
    if (at_[pixel] < 0) continue;
    if (!take_region(pixel) || !is_steady(region_)) continue;
    found_.insert(found_.end(), region_.begin(), region_.end());
    for (const std::size_t member : members_) {
      if (member < near_features_) count(near_[member], -1, other);
    }
  }
  const auto pixels = static_cast<double>(at_.size());
  const bool is_enclosed = static_cast<double>(found_.size()) > image::kMostSelfPart * pixels;
  const bool is_stationary = other.unsteady < image::kLeastUnsteady * other.all;
  if (is_enclosed || is_stationary) {
    std::erase_if(found_, [this](std::size_t pixel) { return self_m_[pixel] == 0.0F; });
  }
  for (const std::size_t pixel : robot_) self_m_[pixel] = 0.0F;
  std::swap(robot_, found_);
  for (const std::size_t pixel : robot_) self_m_[pixel] = seen_[pixel].range_m;
}

void SelfFilter::count(const Feature& f, int by, Structure& structure) const {
  if (f.kind == FeatureKind::ground) return;
  structure.all += by;
  if (!is_steady(seen_[pixel_at(f.column, f.ring)])) structure.unsteady += by;
}

bool SelfFilter::take_region(std::size_t pixel) {
  constexpr int kReach = 2;  // pixels: over one that has no feature
  const auto first = static_cast<std::size_t>(at_[pixel]);
  bool all_near = range_m(near_[first]) < image::kSelfRange_m;
  region_.assign(1, pixel);
  members_.assign(1, first);
  at_[pixel] = -1;
  for (std::size_t k = 0; k < region_.size(); ++k) {
    const Feature& f = near_[members_[k]];
    for (int step = -kReach; step <= kReach; ++step) {
      if (step == 0) continue;
      all_near &= take_neighbour(f, f.column + step, f.ring);
      all_near &= take_neighbour(f, f.column, f.ring + step);
    }
  }
  return all_near;
}

bool SelfFilter::take_neighbour(const Feature& f, int column, int ring) {
  if (ring < 0 || ring >= size_.rings) return true;
  const std::size_t pixel = pixel_at((column + size_.columns) % size_.columns, ring);
  if (at_[pixel] < 0) return true;
  const auto other = static_cast<std::size_t>(at_[pixel]);
  if (!are_one_surface(f, near_[other])) return true;
  region_.push_back(pixel);
  members_.push_back(other);
  at_[pixel] = -1;
  return range_m(near_[other]) < image::kSelfRange_m;
}

bool SelfFilter::is_steady(const Seen& seen) const {
  return seen.scans >= image::kSteadyTime * std::min(scans_, image::kSteadyScans);
}

bool SelfFilter::is_steady(const std::vector<std::size_t>& region) const {
  const auto steady = std::count_if(region.begin(), region.end(),
                                    [&](std::size_t pixel) { return is_steady(seen_[pixel]); });
  return static_cast<double>(steady) >= image::kSteadyPart * static_cast<double>(region.size());
}

bool SelfFilter::is_self(const Feature& f) const {
  constexpr float kFarthest_m = image::kSelfRange_m + image::kSteadyRange_m;
  if (range2_m2(f) > kFarthest_m * kFarthest_m) return false;
  const float range = range_m(f);
  // From scan to scan the firings of a column differ, so its edge may be in the next one.
  constexpr std::array<int, 3> kSteps{-1, 0, 1};
  return std::any_of(kSteps.begin(), kSteps.end(), [&](int step) {
    const int column = (f.column + step + size_.columns) % size_.columns;
    const float self_m = self_m_[pixel_at(column, f.ring)];
    return self_m > 0.0F && std::abs(range - self_m) < image::kSteadyRange_m;
  });
}

}  // namespace lilo::core
