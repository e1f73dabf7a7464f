// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/bvh.hpp"
#include "tools/sim/terrain.hpp"

#include <cstdint>
#include <vector>

namespace lilo::sim {

/// Where a moving object is at one instant.
struct MoverState {
  Vec3 position_m = Vec3::Zero();
  double yaw_rad = 0.0;    ///< continuous: never wrapped
  double pitch_rad = 0.0;  ///< about the object's y axis, after yaw: slopes, swinging legs
};

/// An object with its own motion, sampled every kMoverStep_s and linear in between.
struct Mover {
  std::size_t shape = 0;
  std::vector<MoverState> states;
};
inline constexpr double kMoverStep_s = 0.01;

/// Everything a laser can meet. Fill it, `finish()` it, cast rays into it.
/// cast() is const and touches no shared state: any number of threads.
class Scene {
 public:
  Terrain terrain;
  Mesh fixed;  ///< geometry in world coordinates; given up by finish()

  /// A shape to be put up many times; returns its number.
  std::size_t add_shape(const Mesh& mesh);
  void add_instance(std::size_t shape, const Placement& placement);
  void add_mover(Mover mover) { movers_.push_back(std::move(mover)); }

  void finish();

  /// Nearest surface along the ray `time_s` after the recording's start, not beyond `max_range_m`.
  [[nodiscard]] Hit cast(const Vec3& origin, const Vec3& direction, double time_s,
                         double max_range_m) const;

  [[nodiscard]] std::size_t triangle_count() const;
  [[nodiscard]] std::size_t mover_count() const { return movers_.size(); }

 private:
  struct Instance {
    std::size_t shape;
    Placement placement;
  };
  static void cast_placed(const SolidMesh& shape, const Placement& placement, const Ray& ray,
                          Hit& hit);
  void cast_mover(const Mover& mover, const Ray& ray, double time_s, Hit& hit) const;

  SolidMesh solid_;
  std::vector<SolidMesh> shapes_;
  std::vector<double> shape_radius_m_;  ///< of the sphere about the shape's origin
  std::vector<Instance> instances_;
  Bvh instance_tree_;
  std::vector<Mover> movers_;
};

}  // namespace lilo::sim
