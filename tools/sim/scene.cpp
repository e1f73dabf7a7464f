// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/scene.hpp"

#include "tools/sim/random.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lilo::sim {
namespace {

/// Box of a placed shape, by the corners of the shape's own box.
Box placed_box(const Box& box, const Placement& placement) {
  Box result;
  const Vec3 low = box.low.cast<double>(), high = box.high.cast<double>();
  for (unsigned k = 0; k < 8; ++k) {
    const Vec3 corner((k & 1U) != 0 ? high.x() : low.x(), (k & 2U) != 0 ? high.y() : low.y(),
                      (k & 4U) != 0 ? high.z() : low.z());
    result.grow((placement * corner).cast<float>());
  }
  result.low -= Eigen::Vector3f::Constant(1e-3F);
  result.high += Eigen::Vector3f::Constant(1e-3F);
  return result;
}

}  // namespace

std::size_t Scene::add_shape(const Mesh& mesh) {
  double radius = 0.0;
  for (const Triangle& t : mesh) {
    for (const auto* p : {&t.a, &t.b, &t.c}) {
      radius = std::max(radius, static_cast<double>(p->norm()));
    }
  }
  shapes_.emplace_back(mesh);
  shape_radius_m_.push_back(radius + 1e-3);
  return shapes_.size() - 1;
}

void Scene::add_instance(std::size_t shape, const Placement& placement) {
  instances_.push_back({shape, placement});
}

void Scene::finish() {
  solid_ = SolidMesh(fixed);
  Mesh().swap(fixed);
  std::vector<Box> boxes;
  boxes.reserve(instances_.size());
  for (const Instance& instance : instances_) {
    boxes.push_back(placed_box(shapes_[instance.shape].bounds(), instance.placement));
  }
  instance_tree_ = Bvh(boxes);
  std::vector<Instance> ordered;
  ordered.reserve(instances_.size());
  for (const std::uint32_t item : instance_tree_.order()) ordered.push_back(instances_[item]);
  instances_ = std::move(ordered);
}

std::size_t Scene::triangle_count() const {
  std::size_t count = solid_.size();
  for (const Instance& instance : instances_) count += shapes_[instance.shape].size();
  return count;
}

void Scene::cast_placed(const SolidMesh& shape, const Placement& placement, const Ray& ray,
                        Hit& hit) {
  const auto back = placement.rotation.transpose();
  const Ray local(back * (ray.origin - placement.translation_m) / placement.scale,
                  back * ray.direction);
  Hit inside{hit.range_m / placement.scale};
  shape.cast(local, inside);
  if (!inside.found) return;
  hit = inside;
  hit.range_m = inside.range_m * placement.scale;
  hit.normal = placement.rotation * inside.normal;
}

void Scene::cast_mover(const Mover& mover, const Ray& ray, double time_s, Hit& hit) const {
  const double at =
      std::clamp(time_s / kMoverStep_s, 0.0, static_cast<double>(mover.states.size()) - 1.001);
  const auto index = static_cast<std::size_t>(at);
  const double s = at - static_cast<double>(index);
  const MoverState& a = mover.states[index];
  const MoverState& b = mover.states[index + 1];
  const Vec3 position = (1.0 - s) * a.position_m + s * b.position_m;
  const Vec3 to = position - ray.origin;
  const double along = to.dot(ray.direction), radius = shape_radius_m_[mover.shape];
  if (to.squaredNorm() - along * along > radius * radius) return;
  if (along < -radius || along - radius > hit.range_m) return;
  const SinCos pitch = sin_cos((1.0 - s) * a.pitch_rad + s * b.pitch_rad);
  Placement placement = place(position, (1.0 - s) * a.yaw_rad + s * b.yaw_rad);
  Eigen::Matrix3d tilt;
  tilt << pitch.cos, 0.0, pitch.sin, 0.0, 1.0, 0.0, -pitch.sin, 0.0, pitch.cos;
  placement.rotation = placement.rotation * tilt;
  cast_placed(shapes_[mover.shape], placement, ray, hit);
}

Hit Scene::cast(const Vec3& origin, const Vec3& direction, double time_s,
                double max_range_m) const {
  const Ray ray(origin, direction);
  Hit hit{max_range_m};
  terrain.cast(ray, hit);
  solid_.cast(ray, hit);
  instance_tree_.traverse(ray, hit.range_m, [&](std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t k = first; k < first + count; ++k) {
      cast_placed(shapes_[instances_[k].shape], instances_[k].placement, ray, hit);
    }
  });
  for (const Mover& mover : movers_) cast_mover(mover, ray, time_s, hit);
  return hit;
}

}  // namespace lilo::sim
