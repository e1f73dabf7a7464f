// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/ray.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace lilo::sim {

/// Tree of boxes over any items that have a box (binned surface-area heuristic, Wald 2007).
/// Built once, then read by any number of threads.
class Bvh {
 public:
  Bvh() = default;
  explicit Bvh(const std::vector<Box>& boxes);

  /// Item numbers in the order of the leaves.
  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }
  [[nodiscard]] Box bounds() const { return nodes_.empty() ? Box{} : nodes_.front().box; }

  /// Calls `visit(first, count)` for leaves that the ray meets before `limit`, nearest boxes first;
  /// [first, first + count) index order(). `visit` may lower `limit`.
  template <typename Visit>
  void traverse(const Ray& ray, const double& limit, Visit&& visit) const;

 private:
  struct Node {
    Box box;
    std::uint32_t first =
        0;  ///< leaf: first item; inner node: left child, the right one follows it
    std::uint32_t count = 0;  ///< 0: inner node
  };
  struct Build;

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

template <typename Visit>
void Bvh::traverse(const Ray& ray, const double& limit, Visit&& visit) const {
  struct Entry {
    double near;
    std::uint32_t node;
  };
  if (nodes_.empty()) return;
  std::array<Entry, 64> stack;  // NOLINT: left uninitialised, this is the inner loop
  int size = 0;
  const double root = nodes_.front().box.enter(ray, limit);
  if (root <= limit) stack[static_cast<std::size_t>(size++)] = {root, 0};
  while (size > 0) {
    const Entry entry = stack[static_cast<std::size_t>(--size)];
    if (entry.near > limit) continue;
    const Node& node = nodes_[entry.node];
    if (node.count > 0) {
      visit(node.first, node.count);
      continue;
    }
    Entry near{nodes_[node.first].box.enter(ray, limit), node.first};
    Entry far{nodes_[node.first + 1].box.enter(ray, limit), node.first + 1};
    if (far.near < near.near) std::swap(near, far);
    if (far.near <= limit) stack[static_cast<std::size_t>(size++)] = far;
    if (near.near <= limit) stack[static_cast<std::size_t>(size++)] = near;
  }
}

/// Triangles that answer rays.
class SolidMesh {
 public:
  SolidMesh() = default;
  explicit SolidMesh(const Mesh& mesh);

  /// Lowers `hit` to the nearest triangle, if one is nearer.
  void cast(const Ray& ray, Hit& hit) const;
  [[nodiscard]] Box bounds() const { return bvh_.bounds(); }
  [[nodiscard]] std::size_t size() const { return triangles_.size(); }

 private:
  Mesh triangles_;  ///< in leaf order
  Bvh bvh_;
};

}  // namespace lilo::sim
