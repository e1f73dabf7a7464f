// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/constants.hpp"
#include "core/feature.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace lilo::core {

/// Chooses the features to align: one a voxel, so that near and far surfaces count by their area
/// and not by the density of the rays. The voxels of each kind follow the scene, to keep the
/// numbers of features near their goals. Features are visited spread over the image: the first of a
/// voxel in azimuth order would always be the one on the same side of it, and bend the path.
/// No allocation after construction.
class Selection {
 public:
  Selection(int ground_goal, int structure_goal);

  /// The chosen features, in the image's order; the result lives until the next call.
  /// `with_overhead`: also of what is_overhead().
  const std::vector<Feature>& choose(const std::vector<Feature>& all, bool with_overhead = true);

  /// What choose() gave last.
  [[nodiscard]] const std::vector<Feature>& chosen() const { return chosen_; }

  /// A step that visits all of `size` elements, one after the other far apart and evenly spread.
  [[nodiscard]] static std::size_t golden_stride(std::size_t size);

  /// More are never chosen.
  [[nodiscard]] std::size_t most() const { return chosen_.capacity(); }

 private:
  static constexpr int kKinds = 2;
  /// What voxels_ holds instead of a voxel.
  static constexpr std::uint64_t kLeftOut = 0, kPicked = ~std::uint64_t{0};
  static constexpr int kKindBit = 48;
  [[nodiscard]] static std::uint64_t voxel_of(const Feature& f, float per_m);
  [[nodiscard]] static std::size_t kind_of(std::uint64_t voxel) { return (voxel - 1) >> kKindBit; }
  /// False when a goal was reached twice over before the end, or not even half though there is
  /// more. Adapts the voxels in any case.
  bool take_evenly(const std::vector<Feature>& all, bool with_overhead);
  bool take(std::uint64_t voxel);

  std::array<int, kKinds> goal_;
  std::array<float, kKinds> voxel_m_ = image::kFirstVoxel_m;
  std::vector<std::uint64_t> taken_;  // hash set of voxels, 0: empty
  std::size_t mask_;
  std::vector<std::uint64_t> voxels_;  // of each feature
  std::vector<Feature> chosen_;
};

/// How thin_out() spreads the features that it keeps.
enum class Evenly {
  in_image,    ///< one of so many returns of a ring
  along_rings  ///< one of so many metres: returns lie the farther apart the farther they are
};

/// `most` of them at most. In the image's order every second feature would be every second ring,
/// wherever columns are filled alike: each ring is thinned out by itself. `with_overhead`: also of
/// what is_overhead().
void thin_out(const std::vector<Feature>& all, std::size_t most, Evenly evenly,
              std::vector<Feature>& fewer, bool with_overhead = true);

}  // namespace lilo::core
