// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/furniture.hpp"

namespace lilo::sim {

Mesh make_lamp_post(Random& random) {
  Mesh mesh;
  const double height = random.uniform(4.0, 9.0), radius = random.uniform(0.05, 0.1);
  add_frustum(mesh, {0, 0, -0.3}, {0, 0, 1.1}, 1.6 * radius, 1.5 * radius, 12, Material::metal);
  add_frustum(mesh, {0, 0, 1.1}, {0, 0, height}, 1.1 * radius, 0.6 * radius, 12, Material::metal);
  const double arm = random.chance(0.7) ? random.uniform(0.8, 2.0) : 0.2;
  add_frustum(mesh, {0, 0, height - 0.05}, {0, arm, height + 0.15}, 0.04, 0.03, 8, Material::metal);
  add_box(mesh, {-0.12, arm - 0.1, height + 0.08}, {0.12, arm + 0.5, height + 0.2},
          Material::paint);
  return mesh;
}

Mesh make_sign(Random& random) {
  Mesh mesh;
  const double height = random.uniform(2.2, 3.0);
  add_frustum(mesh, {0, 0, -0.3}, {0, 0, height}, 0.035, 0.035, 10, Material::metal);
  double top = height;
  const int plates = 1 + random.below(2);
  for (int k = 0; k < plates; ++k) {
    const double w = random.uniform(0.25, 0.45), h = random.uniform(0.3, 0.7);
    add_box(mesh, {-0.06, -w, top - h}, {-0.05, w, top}, Material::retro);
    top -= h + 0.05;
  }
  return mesh;
}

Mesh make_bollard(Random& random) {
  Mesh mesh;
  const double height = random.uniform(0.7, 1.1), radius = random.uniform(0.05, 0.12);
  add_frustum(mesh, {0, 0, -0.2}, {0, 0, height}, radius, 0.9 * radius, 12, Material::paint);
  return mesh;
}

Mesh make_bin(Random& random) {
  Mesh mesh;
  if (random.chance(0.5)) {
    add_frustum(mesh, {0, 0, -0.1}, {0, 0, random.uniform(0.7, 1.0)}, 0.22, 0.27, 14,
                Material::metal);
  } else {
    const double w = random.uniform(0.25, 0.6);
    add_box(mesh, {-w, -0.35, -0.1}, {w, 0.35, random.uniform(0.9, 1.35)}, Material::paint);
  }
  return mesh;
}

Mesh make_bench(Random& random) {
  Mesh mesh;
  const double half = random.uniform(0.7, 1.0);
  for (const double x : {-0.8 * half, 0.8 * half}) {
    add_box(mesh, {x - 0.04, -0.22, -0.1}, {x + 0.04, 0.22, 0.42}, Material::metal);
  }
  for (int slat = 0; slat < 4; ++slat) {
    const double y = -0.22 + 0.115 * slat;
    add_box(mesh, {-half, y, 0.42}, {half, y + 0.09, 0.46}, Material::bark);
  }
  for (int slat = 0; slat < 3; ++slat) {
    const double z = 0.52 + 0.12 * slat;
    add_box(mesh, {-half, 0.24 + 0.03 * slat, z}, {half, 0.27 + 0.03 * slat, z + 0.09},
            Material::bark);
  }
  return mesh;
}

Mesh make_line_post(Random& random) {
  Mesh mesh;
  const double height = random.uniform(7.0, 9.0);
  add_frustum(mesh, {0, 0, -0.5}, {random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), height},
              0.17, 0.11, 14, Material::bark);
  add_box(mesh, {-0.06, -0.9, height - 0.6}, {0.06, 0.9, height - 0.45}, Material::bark);
  return mesh;
}

Mesh make_delineator(Random& random) {
  Mesh mesh;
  const double height = random.uniform(0.9, 1.05);
  add_box(mesh, {-0.04, -0.06, -0.2}, {0.04, 0.06, height}, Material::paint);
  add_box(mesh, {-0.045, -0.03, height - 0.25}, {0.045, 0.03, height - 0.07}, Material::retro);
  return mesh;
}

Mesh make_rock(Random& random) {
  Mesh mesh;
  const double size = random.uniform(0.2, 0.9);
  add_ellipsoid(mesh, Vec3::Zero(),
                {size, size * random.uniform(0.6, 1.2), size * random.uniform(0.4, 0.8)}, 5,
                Material::concrete);
  // Shared corners must move together: the displacement is a function of the corner.
  for (Triangle& t : mesh) {
    for (auto* p : {&t.a, &t.b, &t.c}) {
      const auto key = static_cast<std::uint64_t>(static_cast<std::int64_t>(p->x() * 977.0F) * 31 +
                                                  static_cast<std::int64_t>(p->y() * 977.0F) * 17 +
                                                  static_cast<std::int64_t>(p->z() * 977.0F));
      *p *= static_cast<float>(Random(key).uniform(0.8, 1.15));
    }
  }
  return mesh;
}

}  // namespace lilo::sim
