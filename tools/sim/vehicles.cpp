// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/vehicles.hpp"

#include <array>
#include <utility>
#include <vector>

namespace lilo::sim {
namespace {

void add_wheels(Mesh& mesh, double half_base, double half_track, double radius) {
  for (const double x : {-half_base, half_base}) {
    for (const double side : {-1.0, 1.0}) {
      add_frustum(mesh, {x, side * (half_track - 0.2), radius}, {x, side * half_track, radius},
                  radius, radius, 16, Material::cloth);
    }
  }
}

/// One corner of a car's outline seen from the side.
struct Corner {
  double x, z;
  double half_width;
  Material to_next;  ///< of the strip between this corner and the next
};

/// A body that has the outline as its side view: strips across, and the two sides.
void add_outline(Mesh& mesh, const std::vector<Corner>& outline, double sill_m) {
  for (std::size_t k = 0; k + 1 < outline.size(); ++k) {
    const Corner& a = outline[k];
    const Corner& b = outline[k + 1];
    const Vec3 al(a.x, a.half_width, a.z), ar(a.x, -a.half_width, a.z);
    const Vec3 bl(b.x, b.half_width, b.z), br(b.x, -b.half_width, b.z);
    add_triangle(mesh, al, ar, br, a.to_next);
    add_triangle(mesh, al, br, bl, a.to_next);
    for (const double side : {-1.0, 1.0}) {
      const Vec3 ta(a.x, side * a.half_width, a.z), tb(b.x, side * b.half_width, b.z);
      const Vec3 fa(a.x, side * outline.front().half_width, sill_m);
      const Vec3 fb(b.x, side * outline.front().half_width, sill_m);
      const Material side_material =
          a.to_next == Material::glass ? Material::glass : Material::paint;
      add_triangle(mesh, ta, tb, fb, side_material);
      add_triangle(mesh, ta, fb, fa, side_material);
    }
  }
}

}  // namespace

Mesh make_car(Random& random) {
  Mesh mesh;
  const double half = 0.5 * random.uniform(3.6, 5.2), width = 0.5 * random.uniform(1.65, 1.95);
  const double height = random.uniform(1.4, half > 2.3 ? 2.1 : 1.6),
               bonnet = random.uniform(0.8, 1.0);
  const double sill = random.uniform(0.16, 0.25), roof = 0.8 * width;
  const double front = half * random.uniform(0.4, 0.55), rear = -half * random.uniform(0.55, 0.9);
  add_outline(mesh,
              {{half, sill + 0.1, width, Material::paint},
               {half - 0.05, 0.75 * bonnet, width, Material::paint},
               {front, bonnet, width, Material::glass},
               {front - 0.6 * (height - bonnet) / 0.5, height - 0.05, roof, Material::paint},
               {0.5 * (front + rear) - 0.3, height, roof, Material::paint},
               {rear, height - 0.08, roof, Material::glass},
               {-half + 0.1, bonnet + 0.05, width, Material::paint},
               {-half, sill + 0.15, width, Material::paint}},
              sill);
  add_box(mesh, {front - 0.25, -width - 0.18, bonnet}, {front - 0.1, -width, bonnet + 0.14},
          Material::paint);
  add_box(mesh, {front - 0.25, width, bonnet}, {front - 0.1, width + 0.18, bonnet + 0.14},
          Material::paint);
  add_box(mesh, {-half - 0.01, -0.26, 0.5}, {-half, 0.26, 0.62}, Material::retro);
  add_wheels(mesh, 0.6 * half, width, random.uniform(0.29, 0.36));
  return mesh;
}

Mesh make_truck(Random& random) {
  Mesh mesh;
  const double half = 0.5 * random.uniform(7.0, 15.0), top = random.uniform(3.0, 3.9);
  add_box(mesh, {half - 2.1, -1.2, 0.6}, {half, 1.2, random.uniform(2.6, 3.4)}, Material::paint);
  add_box(mesh, {half, -1.0, 1.6}, {half + 0.02, 1.0, 2.4}, Material::glass);
  add_box(mesh, {-half, -1.25, 1.0}, {half - 2.5, 1.25, top}, Material::cloth);
  add_box(mesh, {-half + 0.3, -0.5, 0.6}, {half - 0.3, 0.5, 1.0}, Material::metal);
  add_box(mesh, {-half - 0.02, -1.1, 0.7}, {-half, 1.1, 0.85}, Material::retro);
  add_wheels(mesh, half - 1.3, 1.2, 0.5);
  add_wheels(mesh, half - 2.7, 1.2, 0.5);
  return mesh;
}

Mesh make_walker_body(Random& random) {
  Mesh mesh;
  const double height = random.uniform(1.5, 1.9), width = random.uniform(0.19, 0.27);
  add_ellipsoid(mesh, {0, 0, 0.5 * (kHip_m + height - 0.28)},
                {0.14, width, 0.5 * (height - 0.2 - kHip_m) + 0.06}, 7, Material::cloth);
  add_ellipsoid(mesh, {0.02, 0, height - 0.12}, {0.1, 0.08, 0.12}, 6, Material::cloth);
  for (const double side : {-1.0, 1.0}) {
    add_frustum(mesh, {0, side * (width + 0.02), height - 0.35},
                {random.uniform(-0.2, 0.25), side * (width + 0.08), kHip_m}, 0.055, 0.04, 8,
                Material::cloth);
  }
  if (random.chance(0.4)) add_box(mesh, {-0.32, -0.16, 0.95}, {-0.12, 0.16, 1.4}, Material::cloth);
  return mesh;
}

Mesh make_leg(Random& random) {
  Mesh mesh;
  const double radius = random.uniform(0.07, 0.09);
  add_frustum(mesh, {0, 0, 0}, {0.02, 0, -0.42}, radius, 0.055, 10, Material::cloth);
  add_frustum(mesh, {0.02, 0, -0.42}, {0, 0, -0.8}, 0.055, 0.04, 10, Material::cloth);
  add_box(mesh, {-0.08, -0.05, -0.85}, {0.18, 0.05, -0.77}, Material::cloth);
  return mesh;
}

}  // namespace lilo::sim
