// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/feature.hpp"
#include "core/image/constants.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace lilo::core {

/// Chooses the features to align: one a voxel, so that surfaces count by their area and not by the
/// density of the rays. The voxel of each kind adapts to the scene, so that the number of features
/// stays near its goal. Features are visited spread over the image: in azimuth order the first one
/// of a voxel would always lie on the same side of it, and that bends the path.
/// No allocation after construction.
class Selection {
 public:
  Selection(int ground_goal, int structure_goal);

  /// The chosen features, in the image's order; the result lives until the next call.
  /// `with_overhead`: those that are is_overhead() count too.
  const std::vector<Feature>& choose(const std::vector<Feature>& all, bool with_overhead = true);

  /// The result of the last choose().
  [[nodiscard]] const std::vector<Feature>& chosen() const { return chosen_; }

  /// A stride that visits all of `size` elements, spread evenly: any two in a row are far apart.
  [[nodiscard]] static std::size_t golden_stride(std::size_t size);

  /// The most features that are ever chosen.
  [[nodiscard]] std::size_t most() const { return chosen_.capacity(); }

 private:
  static constexpr int kKinds = 2;
  /// What voxels_ holds instead of a voxel.
  static constexpr std::uint64_t kLeftOut = 0, kPicked = ~std::uint64_t{0};
  static constexpr int kKindBit = 48;
  [[nodiscard]] static std::uint64_t voxel_of(const Feature& f, float per_m);
  [[nodiscard]] static std::size_t kind_of(std::uint64_t voxel) { return (voxel - 1) >> kKindBit; }
  /// Adapts the voxels. False when there were twice as many features as the goal before the end, or
  /// less than half of it although there are more.
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
  along_rings  ///< one in so many metres: returns that are farther away lie farther apart
};

/// Keeps at most `most` features. Each ring is thinned out by itself: in the order of the image
/// every second feature would be every second ring, wherever columns are filled alike.
/// `with_overhead`: those that are is_overhead() count too.
void thin_out(const std::vector<Feature>& all, std::size_t most, Evenly evenly,
              std::vector<Feature>& fewer, bool with_overhead = true);

}  // namespace lilo::core
