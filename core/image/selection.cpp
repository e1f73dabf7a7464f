// SPDX-License-Identifier: BSD-3-Clause
#include "core/image/selection.hpp"

#include "core/image/constants.hpp"
#include "core/scan.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <numeric>

namespace lilo::core {

Selection::Selection(int ground_goal, int structure_goal)
    : goal_{ground_goal, structure_goal},
      taken_(std::bit_ceil(static_cast<std::size_t>(ground_goal + structure_goal) * 4)),
      mask_(taken_.size() - 1) {
  chosen_.reserve(taken_.size() / 2);
  voxels_.reserve(image::kMostPixels);
}

std::size_t Selection::golden_stride(std::size_t size) {
  constexpr double kGolden = 0.6180339887498949;
  auto stride = static_cast<std::size_t>(kGolden * static_cast<double>(size)) | 1U;
  while (std::gcd(stride, size) > 1) stride += 2;
  return stride;
}

std::uint64_t Selection::voxel_of(const Feature& f, float per_m) {
  constexpr float kOffset = 1 << 15;  // all are positive then, and to cut off is to round down
  const auto part = [&](float v_m) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(v_m * per_m + kOffset)) & 0xFFFFU;
  };
  return 1U + (part(f.x_m) | part(f.y_m) << 16U | part(f.z_m) << 32U |
               static_cast<std::uint64_t>(f.kind) << kKindBit);
}

bool Selection::take(std::uint64_t voxel) {
  auto slot = static_cast<std::size_t>(voxel * 0x9E3779B97F4A7C15ULL >> 32U) & mask_;
  for (; taken_[slot] != 0; slot = (slot + 1) & mask_) {
    if (taken_[slot] == voxel) return false;
  }
  taken_[slot] = voxel;
  return true;
}

const std::vector<Feature>& Selection::choose(const std::vector<Feature>& all, bool with_overhead) {
  // Too small a voxel, as after a scan that saw little, fills the goal before all features are
  // visited. Too large a one, as in the first scan of a narrow place, leaves too few of them.
  for (int pass = 0; pass < image::kVoxelPasses && !take_evenly(all, with_overhead); ++pass) {
  }
  return chosen_;
}

bool Selection::take_evenly(const std::vector<Feature>& all, bool with_overhead) {
  std::fill(taken_.begin(), taken_.end(), 0);
  chosen_.clear();
  std::array<int, kKinds> count{}, offered{};
  const std::array<float, kKinds> per_m{1.0F / voxel_m_[0], 1.0F / voxel_m_[1]};
  bool done = true;
  // First all voxels in the order of the memory, then far apart: there is little to wait for.
  voxels_.resize(all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Feature& f = all[k];
    const auto kind = static_cast<std::size_t>(f.kind);
    const bool left_out = !with_overhead && is_overhead(f);
    voxels_[k] = left_out ? kLeftOut : voxel_of(f, per_m[kind]);
    offered[kind] += static_cast<int>(!left_out);
  }
  const std::size_t stride = golden_stride(all.size());
  for (std::size_t n = 0, at = 0; n < all.size(); ++n) {
    std::uint64_t& voxel = voxels_[at];
    at += stride;  // less than all.size(): no division a feature
    if (at >= all.size()) at -= all.size();
    if (voxel == kLeftOut) continue;
    const std::size_t kind = kind_of(voxel);
    if (count[kind] >= 2 * goal_[kind]) {
      done = false;
    } else if (take(voxel)) {
      ++count[kind];
      voxel = kPicked;
    }
  }
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (voxels_[k] == kPicked) chosen_.push_back(all[k]);
  }
  for (std::size_t k = 0; k < kKinds; ++k) {
    const float ratio = static_cast<float>(std::max(count[k], 1)) / static_cast<float>(goal_[k]);
    const float before_m = voxel_m_[k];
    voxel_m_[k] = std::clamp(voxel_m_[k] * std::pow(ratio, image::kVoxelPower),
                             image::kLeastVoxel_m, image::kMostVoxel_m);
    const bool few = 2 * count[k] < std::min(goal_[k], offered[k]);
    if (few && voxel_m_[k] < before_m) done = false;
  }
  return done;
}

namespace {

float range_of(const Feature& f) {
  return std::sqrt(f.x_m * f.x_m + f.y_m * f.y_m + f.z_m * f.z_m);
}

/// The range from which on every feature is kept, if nearer ones are kept in proportion to their
/// range and `most` altogether.
template <typename Counts>
float range_kept_whole_m(const std::vector<Feature>& all, const Counts& counts, std::size_t most) {
  // Eight bins an octave: a float's exponent and the first bits of its fraction.
  constexpr std::size_t kBins = 128;
  constexpr std::uint32_t kBinBit = 20, kFirst = std::bit_cast<std::uint32_t>(0.125F) >> kBinBit;
  const auto bin_of = [](float range_m) {
    const std::uint32_t bin = std::bit_cast<std::uint32_t>(range_m) >> kBinBit;
    return std::min<std::size_t>(bin < kFirst ? 0 : bin - kFirst, kBins - 1);
  };
  std::array<std::size_t, kBins> count{};
  std::array<double, kBins> sum_m{};
  std::size_t farther = 0;
  for (const Feature& f : all) {
    if (!counts(f)) continue;
    const float range_m = range_of(f);
    const std::size_t bin = bin_of(range_m);
    ++farther;
    ++count[bin];
    sum_m[bin] += static_cast<double>(range_m);
  }
  double nearer_m = 0.0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    farther -= count[bin];
    nearer_m += sum_m[bin];
    if (farther >= most) continue;
    const auto whole_m = static_cast<float>(nearer_m / static_cast<double>(most - farther));
    if (bin_of(whole_m) <= bin) return whole_m;
  }
  return static_cast<float>(nearer_m / static_cast<double>(most));
}

}  // namespace

void thin_out(const std::vector<Feature>& all, std::size_t most, Evenly evenly,
              std::vector<Feature>& fewer, bool with_overhead) {
  const auto counts = [&](const Feature& f) { return with_overhead || !is_overhead(f); };
  const auto count = static_cast<std::size_t>(std::count_if(all.begin(), all.end(), counts));
  if (count <= most) {
    fewer.clear();
    std::copy_if(all.begin(), all.end(), std::back_inserter(fewer), counts);
    return;
  }
  constexpr std::uint32_t kGolden = 2654435769U;  // of 2^32: rings beside each other lie apart
  const bool in_image = evenly == Evenly::in_image;
  const float part = static_cast<float>(most) / static_cast<float>(count);
  const float part_per_m = in_image ? 0.0F : 1.0F / range_kept_whole_m(all, counts, most);
  std::array<float, kMaxRings> owed{};  // to each ring, in parts of a feature
  for (std::size_t ring = 0; ring < owed.size(); ++ring) {
    owed[ring] = 0x1p-32F * static_cast<float>(static_cast<std::uint32_t>(ring * kGolden));
  }
  fewer.resize(most);
  std::size_t n = 0;
  for (const Feature& f : all) {
    if (n == most) break;
    if (!counts(f)) continue;
    // A branch would be predicted wrongly half of the time.
    float& parts = owed[f.ring];
    parts += in_image ? part : std::min(1.0F, range_of(f) * part_per_m);
    const bool due = parts >= 1.0F;
    parts -= due ? 1.0F : 0.0F;
    fewer[n] = f;
    n += static_cast<std::size_t>(due);
  }
  fewer.resize(n);
}

}  // namespace lilo::core
