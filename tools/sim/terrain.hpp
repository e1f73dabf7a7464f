// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/ray.hpp"

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace lilo::sim {

/// Part of the plane that the ground covers.
struct Extent {
  double x_low = 0.0, y_low = 0.0, x_high = 0.0, y_high = 0.0;
};

/// Ground as a triangulated height grid: two triangles a cell, a pyramid of height ranges above it
/// for the search.
class Terrain {
 public:
  struct Sample {
    double height_m;
    Material material;
  };
  using Ground = std::function<Sample(double x, double y)>;

  Terrain() = default;
  /// `cell_m` is doubled until the grid has at most 16 million cells.
  Terrain(const Extent& extent, double cell_m, const Ground& ground);

  /// Height of the surface that rays hit (the triangles, not `ground` itself); beyond the border
  /// that of the nearest border point.
  [[nodiscard]] double height(double x, double y) const;
  void cast(const Ray& ray, Hit& hit) const;

 private:
  struct Level {
    int nx = 0, ny = 0;
    double cell_m = 0.0;
    std::vector<std::pair<float, float>> range;  ///< lowest and highest point of each node
  };
  struct Node {
    int level, i, j;
  };
  void build_pyramid();
  [[nodiscard]] double enter(const Ray& ray, const Node& node, double limit) const;
  void cast_cell(const Ray& ray, int i, int j, Hit& hit) const;
  [[nodiscard]] Vec3 vertex(int i, int j) const {
    return {x0_ + i * cell_m_, y0_ + j * cell_m_,
            static_cast<double>(
                heights_[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_ + 1) +
                         static_cast<std::size_t>(i)])};
  }

  double x0_ = 0.0, y0_ = 0.0, cell_m_ = 1.0;
  int nx_ = 0, ny_ = 0;         ///< cells
  std::vector<float> heights_;  ///< (nx + 1) x (ny + 1) vertices, row by row
  std::vector<Material> materials_;
  std::vector<Level> levels_;
};

}  // namespace lilo::sim
