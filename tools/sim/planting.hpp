// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/random.hpp"
#include "tools/sim/route.hpp"
#include "tools/sim/scene.hpp"

#include <vector>

namespace lilo::sim {

/// Several shapes of one kind, to be put up again and again at other sizes and turns.
class ShapeSet {
 public:
  /// Makes `count` different ones with `make(random)`.
  template <typename Make>
  ShapeSet(Scene& scene, Random& random, int count, Make&& make) {
    for (int k = 0; k < count; ++k) shapes_.push_back(scene.add_shape(make(random)));
  }
  [[nodiscard]] std::size_t any(Random& random) const {
    return shapes_[static_cast<std::size_t>(random.below(static_cast<int>(shapes_.size())))];
  }

 private:
  std::vector<std::size_t> shapes_;
};

/// Puts objects on the ground of a scene beside its route.
class Planter {
 public:
  Planter(Scene& scene, const Route& route, Random& random)
      : scene_(scene), route_(route), random_(random) {}

  /// On the ground at (x, y), with a random turn, size and a slight lean.
  void plant(const ShapeSet& set, double x, double y);
  /// `left_m` beside the route at `arc_m`, turned by `yaw_rad` against the route's heading,
  /// upright.
  void stand(const ShapeSet& set, double arc_m, double left_m, double yaw_rad);
  /// About `per_square_m` on every square metre of `extent`, not nearer to the route than
  /// `clearance_m`, clustered as plants are.
  void scatter(const ShapeSet& set, const Extent& extent, double per_square_m, double clearance_m,
               double farthest_m = 1e9);

 private:
  Scene& scene_;
  const Route& route_;
  Random& random_;
};

/// Curvature that wanders: segments of random length and curvature up to `curvature` (1/m).
std::vector<RouteSegment> winding(Random& random, double length_m, double shortest_m,
                                  double longest_m, double curvature);

}  // namespace lilo::sim
