// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/bvh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <numeric>

namespace lilo::sim {
namespace {

constexpr int kBins = 16;
constexpr std::uint32_t kLeafItems = 4;
constexpr int kMaxDepth = 60;  // the traversal's stack holds 64

float half_area(const Box& box) {
  const Eigen::Vector3f d = (box.high - box.low).cwiseMax(0.0F);
  return d.x() * d.y() + d.y() * d.z() + d.z() * d.x();
}

constexpr float kHuge = 3e38F;

struct Split {
  int axis = -1;
  float position = 0.0F;
  float cost = kHuge;
};

}  // namespace

struct Bvh::Build {
  const std::vector<Box>& boxes;
  std::vector<Eigen::Vector3f> centres;
  Bvh& bvh;

  /// The cheapest of kBins - 1 splits along one axis, if it is cheaper than `best`.
  void try_axis(int axis, const Box& spread, std::uint32_t first, std::uint32_t count,
                Split& best) const {
    const float width = spread.high[axis] - spread.low[axis];
    if (!(width > 0.0F)) return;
    std::array<Box, kBins> bin_box;
    std::array<int, kBins> bin_count{};
    const float scale = static_cast<float>(kBins) / width;
    for (std::uint32_t k = first; k < first + count; ++k) {
      const std::uint32_t item = bvh.order_[k];
      const auto bin = static_cast<int>((centres[item][axis] - spread.low[axis]) * scale);
      const auto b = static_cast<std::size_t>(std::min(kBins - 1, bin));
      bin_box[b].grow(boxes[item]);
      ++bin_count[b];
    }
    std::array<float, kBins> right_cost{};
    Box right, left;
    int right_count = 0, left_count = 0;
    for (std::size_t b = kBins - 1; b > 0; --b) {
      right.grow(bin_box[b]);
      right_count += bin_count[b];
      right_cost[b] = right_count > 0 ? half_area(right) * static_cast<float>(right_count) : kHuge;
    }
    for (std::size_t b = 0; b + 1 < kBins; ++b) {
      left.grow(bin_box[b]);
      left_count += bin_count[b];
      if (left_count == 0) continue;
      const float cost = half_area(left) * static_cast<float>(left_count) + right_cost[b + 1];
      if (cost >= best.cost) continue;
      best = {axis, spread.low[axis] + static_cast<float>(b + 1) / scale, cost};
    }
  }

  [[nodiscard]] Split best_split(std::uint32_t first, std::uint32_t count) const {
    Box spread;
    for (std::uint32_t k = first; k < first + count; ++k) spread.grow(centres[bvh.order_[k]]);
    Split best;
    for (int axis = 0; axis < 3; ++axis) try_axis(axis, spread, first, count, best);
    return best;
  }

  void subdivide(std::uint32_t index, std::uint32_t first, std::uint32_t count, int depth) {
    Box box;
    for (std::uint32_t k = first; k < first + count; ++k) box.grow(boxes[bvh.order_[k]]);
    bvh.nodes_[index] = {box, first, count};
    if (count <= kLeafItems || depth >= kMaxDepth) return;
    const Split split = best_split(first, count);
    const auto begin = bvh.order_.begin() + first, end = begin + count;
    auto middle = begin;
    if (split.axis >= 0) {
      middle = std::partition(begin, end, [&](std::uint32_t item) {
        return centres[item][split.axis] < split.position;
      });
    }
    if (middle == begin || middle == end) middle = begin + count / 2;  // all centres fall together
    const auto left_count = static_cast<std::uint32_t>(middle - begin);
    const auto left = static_cast<std::uint32_t>(bvh.nodes_.size());
    bvh.nodes_.resize(bvh.nodes_.size() + 2);
    bvh.nodes_[index].first = left;
    bvh.nodes_[index].count = 0;
    subdivide(left, first, left_count, depth + 1);
    subdivide(left + 1, first + left_count, count - left_count, depth + 1);
  }
};

Bvh::Bvh(const std::vector<Box>& boxes) : order_(boxes.size()) {
  if (boxes.empty()) return;
  std::iota(order_.begin(), order_.end(), 0U);
  Build build{boxes, {}, *this};
  build.centres.reserve(boxes.size());
  for (const Box& box : boxes) build.centres.emplace_back(0.5F * (box.low + box.high));
  nodes_.reserve(boxes.size());
  nodes_.resize(1);
  build.subdivide(0, 0, static_cast<std::uint32_t>(boxes.size()), 0);
}

SolidMesh::SolidMesh(const Mesh& mesh) {
  std::vector<Box> boxes(mesh.size());
  for (std::size_t k = 0; k < mesh.size(); ++k) {
    boxes[k].grow(mesh[k].a);
    boxes[k].grow(mesh[k].b);
    boxes[k].grow(mesh[k].c);
    // Flat boxes get a thickness, so that rounding in the slab test cannot lose them.
    const Eigen::Vector3f margin = Eigen::Vector3f::Constant(1e-4F);
    boxes[k].low -= margin;
    boxes[k].high += margin;
  }
  bvh_ = Bvh(boxes);
  triangles_.reserve(mesh.size());
  for (const std::uint32_t item : bvh_.order()) triangles_.push_back(mesh[item]);
}

void SolidMesh::cast(const Ray& ray, Hit& hit) const {
  const Triangle* nearest = nullptr;
  bvh_.traverse(ray, hit.range_m, [&](std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t k = first; k < first + count; ++k) {
      const Triangle& t = triangles_[k];
      const double range =
          intersect(ray, t.a.cast<double>(), t.b.cast<double>(), t.c.cast<double>());
      if (range < hit.range_m) {
        hit.range_m = range;
        nearest = &t;
      }
    }
  });
  if (nearest == nullptr) return;
  const Vec3 a = nearest->a.cast<double>();
  hit.normal = (nearest->b.cast<double>() - a).cross(nearest->c.cast<double>() - a).normalized();
  hit.material = nearest->material;
  hit.found = true;
}

}  // namespace lilo::sim
