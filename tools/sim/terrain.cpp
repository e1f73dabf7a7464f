// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/terrain.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

namespace lilo::sim {
namespace {

std::size_t at(int i, int j, int width) {
  return static_cast<std::size_t>(j) * static_cast<std::size_t>(width) +
         static_cast<std::size_t>(i);
}

}  // namespace

Terrain::Terrain(const Extent& extent, double cell_m, const Ground& ground)
    : x0_(extent.x_low), y0_(extent.y_low), cell_m_(cell_m) {
  constexpr double kMostCells = 16e6;
  const double width = extent.x_high - extent.x_low, depth = extent.y_high - extent.y_low;
  while (width * depth / (cell_m_ * cell_m_) > kMostCells) cell_m_ *= 2.0;
  nx_ = std::max(1, static_cast<int>(std::ceil(width / cell_m_)));
  ny_ = std::max(1, static_cast<int>(std::ceil(depth / cell_m_)));
  heights_.reserve(at(0, ny_ + 1, nx_ + 1));
  materials_.reserve(at(0, ny_ + 1, nx_ + 1));
  for (int j = 0; j <= ny_; ++j) {
    for (int i = 0; i <= nx_; ++i) {
      const Sample sample = ground(x0_ + i * cell_m_, y0_ + j * cell_m_);
      heights_.push_back(static_cast<float>(sample.height_m));
      materials_.push_back(sample.material);
    }
  }
  build_pyramid();
}

void Terrain::build_pyramid() {
  Level base{nx_, ny_, cell_m_, {}};
  base.range.reserve(at(0, ny_, nx_));
  for (int j = 0; j < ny_; ++j) {
    for (int i = 0; i < nx_; ++i) {
      const int w = nx_ + 1;
      base.range.push_back(std::minmax({heights_[at(i, j, w)], heights_[at(i + 1, j, w)],
                                        heights_[at(i, j + 1, w)], heights_[at(i + 1, j + 1, w)]}));
    }
  }
  levels_.push_back(std::move(base));
  while (levels_.back().nx > 1 || levels_.back().ny > 1) {
    const Level& fine = levels_.back();
    Level coarse{(fine.nx + 1) / 2, (fine.ny + 1) / 2, fine.cell_m * 2.0, {}};
    coarse.range.assign(at(0, coarse.ny, coarse.nx), {3e38F, -3e38F});
    for (int j = 0; j < fine.ny; ++j) {
      for (int i = 0; i < fine.nx; ++i) {
        auto& range = coarse.range[at(i / 2, j / 2, coarse.nx)];
        range.first = std::min(range.first, fine.range[at(i, j, fine.nx)].first);
        range.second = std::max(range.second, fine.range[at(i, j, fine.nx)].second);
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

double Terrain::height(double x, double y) const {
  const double u = std::clamp((x - x0_) / cell_m_, 0.0, nx_ - 1e-9);
  const double v = std::clamp((y - y0_) / cell_m_, 0.0, ny_ - 1e-9);
  const int i = static_cast<int>(u), j = static_cast<int>(v);
  const double a = u - i, b = v - j;
  const double z00 = vertex(i, j).z(), z11 = vertex(i + 1, j + 1).z();
  // The cell's diagonal runs from (i, j) to (i + 1, j + 1).
  if (a >= b) {
    const double z10 = vertex(i + 1, j).z();
    return z00 + a * (z10 - z00) + b * (z11 - z10);
  }
  const double z01 = vertex(i, j + 1).z();
  return z00 + b * (z01 - z00) + a * (z11 - z01);
}

double Terrain::enter(const Ray& ray, const Node& node, double limit) const {
  const Level& level = levels_[static_cast<std::size_t>(node.level)];
  const auto& [low, high] = level.range[at(node.i, node.j, level.nx)];
  constexpr double kMargin = 1e-6;
  const std::array<double, 3> lower{x0_ + node.i * level.cell_m - kMargin,
                                    y0_ + node.j * level.cell_m - kMargin,
                                    static_cast<double>(low) - kMargin};
  const std::array<double, 3> upper{lower[0] + level.cell_m + 2 * kMargin,
                                    lower[1] + level.cell_m + 2 * kMargin,
                                    static_cast<double>(high) + kMargin};
  double near = 0.0, far = limit;
  for (int k = 0; k < 3; ++k) {
    const double t0 = (lower[static_cast<std::size_t>(k)] - ray.origin[k]) * ray.inverse[k];
    const double t1 = (upper[static_cast<std::size_t>(k)] - ray.origin[k]) * ray.inverse[k];
    near = std::max(near, std::min(t0, t1));
    far = std::min(far, std::max(t0, t1));
  }
  return near <= far ? near : Box::kMiss;
}

void Terrain::cast_cell(const Ray& ray, int i, int j, Hit& hit) const {
  const Vec3 p00 = vertex(i, j), p10 = vertex(i + 1, j), p01 = vertex(i, j + 1),
             p11 = vertex(i + 1, j + 1);
  const auto try_triangle = [&](const Vec3& b, const Vec3& c) {
    const double range = intersect(ray, p00, b, c);
    if (range >= hit.range_m) return;
    hit.range_m = range;
    hit.normal = (b - p00).cross(c - p00).normalized();
    hit.material = materials_[at(i, j, nx_ + 1)];
    hit.found = true;
  };
  try_triangle(p10, p11);
  try_triangle(p11, p01);
}

void Terrain::cast(const Ray& ray, Hit& hit) const {
  if (levels_.empty()) return;
  // Children are visited in the order in which a ray of this direction can meet them, so the first
  // hit is the nearest.
  const int flip_i = ray.direction.x() < 0.0 ? 1 : 0, flip_j = ray.direction.y() < 0.0 ? 1 : 0;
  std::array<Node, 128> stack;  // NOLINT: left uninitialised, this is the inner loop
  std::size_t size = 0;
  stack[size++] = {static_cast<int>(levels_.size()) - 1, 0, 0};
  const double before = hit.range_m;
  while (size > 0 && hit.range_m == before) {
    const Node node = stack[--size];
    if (enter(ray, node, hit.range_m) > hit.range_m) continue;
    if (node.level == 0) {
      cast_cell(ray, node.i, node.j, hit);
      continue;
    }
    const Level& finer = levels_[static_cast<std::size_t>(node.level) - 1];
    for (int k = 3; k >= 0; --k) {
      const int i = 2 * node.i + ((k & 1) ^ flip_i), j = 2 * node.j + ((k >> 1) ^ flip_j);
      if (i < finer.nx && j < finer.ny) stack[size++] = {node.level - 1, i, j};
    }
  }
}

}  // namespace lilo::sim
