// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/road_furniture.hpp"

#include <algorithm>
#include <array>

namespace lilo::sim {
namespace {

constexpr double kHalf = 0.5 * kPiece_m;

}  // namespace

Mesh make_guard_rail(Random& random) {
  Mesh mesh;
  const double top = 0.75 + random.uniform(-0.03, 0.03), dent = random.chance(0.1) ? 0.12 : 0.0;
  // Two waves of 0.31 m: five strips across.
  constexpr std::array<double, 6> y{0.0, -0.08, 0.0, 0.0, -0.08, 0.0};
  constexpr std::array<double, 6> z{0.0, -0.075, -0.14, -0.17, -0.235, -0.31};
  for (std::size_t k = 0; k < 5; ++k) {
    const Vec3 a(-kHalf, y[k], top + z[k]), b(-kHalf, y[k + 1], top + z[k + 1]);
    const Vec3 half(kHalf, dent, 0.0), rest(kHalf, -dent, 0.0);
    add_quad(mesh, a, b - a, half, Material::metal);
    add_quad(mesh, a + half, b - a, rest, Material::metal);
  }
  for (const double x : {-1.0, 1.0}) {
    add_box(mesh, {x - 0.05, 0.01, -0.5}, {x + 0.05, 0.16, top}, Material::metal);
  }
  return mesh;
}

Mesh make_concrete_barrier(Random& random) {
  Mesh mesh;
  const double gap = random.uniform(0.0, 0.02), height = random.uniform(0.79, 0.83);
  constexpr std::array<double, 4> y{0.3, 0.24, 0.12, 0.09};
  const std::array<double, 4> z{-0.3, 0.1, 0.33, height};
  const Vec3 along(kPiece_m - gap, 0.0, 0.0);
  for (std::size_t k = 0; k < 3; ++k) {
    for (const double side : {-1.0, 1.0}) {
      const Vec3 a(-kHalf, side * y[k], z[k]), b(-kHalf, side * y[k + 1], z[k + 1]);
      add_quad(mesh, a, along, b - a, Material::concrete);
    }
  }
  add_quad(mesh, {-kHalf, -0.09, height}, along, {0.0, 0.18, 0.0}, Material::concrete);
  return mesh;
}

Mesh make_noise_wall(Random& random) {
  Mesh mesh;
  const double height = random.uniform(2.5, 4.0);
  add_box(mesh, {-kHalf - 0.1, -0.12, -0.5}, {-kHalf + 0.1, 0.12, height + 0.1}, Material::metal);
  for (double z = 0.0; z < height - 0.2; z += 0.5) {
    const double set = random.uniform(-0.03, 0.03);
    add_box(mesh, {-kHalf, set - 0.06, z - 0.4}, {kHalf, set + 0.06, z + 0.5}, Material::plaster);
  }
  return mesh;
}

Mesh make_fence(Random& random) {
  Mesh mesh;
  for (const double x : {-kHalf, 0.0}) {
    const double lean = random.uniform(-0.08, 0.08);
    add_frustum(mesh, {x, 0, -0.3}, {x + lean, 0.5 * lean, random.uniform(1.0, 1.3)}, 0.055, 0.05,
                8, Material::bark);
  }
  for (const double z : {0.45, 0.95}) {
    const Vec3 from(-kHalf, 0.05, z + random.uniform(-0.06, 0.06));
    const Vec3 to(kHalf, 0.05, z + random.uniform(-0.06, 0.06));
    if (random.chance(0.85)) add_frustum(mesh, from, to, 0.03, 0.03, 5, Material::bark);
  }
  return mesh;
}

Mesh make_gantry(Random& random, double half_width_m) {
  Mesh mesh;
  const double height = random.uniform(5.6, 6.6);
  for (const double y : {-half_width_m, half_width_m}) {
    add_frustum(mesh, {0, y, -0.5}, {0, y, height + 1.0}, 0.22, 0.2, 14, Material::metal);
  }
  for (const double z : {height, height + 1.0}) {
    add_box(mesh, {-0.1, -half_width_m, z - 0.1}, {0.1, half_width_m, z + 0.1}, Material::metal);
  }
  for (double y = -half_width_m; y < half_width_m; y += 1.0) {
    add_frustum(mesh, {0, y, height}, {0, y + 1.0, height + 1.0}, 0.04, 0.04, 6, Material::metal);
  }
  for (double y = -half_width_m + 2.0; y < half_width_m - 5.0; y += random.uniform(4.5, 8.0)) {
    if (random.chance(0.7)) {
      const double w = random.uniform(2.0, 4.0), h = random.uniform(1.2, 2.6);
      add_box(mesh, {-0.3, y, height - 0.3}, {-0.24, y + w, height - 0.3 + h}, Material::retro);
    }
  }
  return mesh;
}

Mesh make_bridge(Random& random, double half_width_m) {
  Mesh mesh;
  const double deck = random.uniform(5.2, 6.0), half = random.uniform(3.5, 6.0);
  for (const double side : {-1.0, 1.0}) {
    const double y0 = side * half_width_m, y1 = side * (half_width_m + 1.2);
    add_box(mesh, {-half, std::min(y0, y1), -2.0}, {half, std::max(y0, y1), deck},
            Material::concrete);
    add_quad(mesh, {-half, y1, deck}, {0.0, side * 14.0, -6.0}, {2.0 * half, 0.0, 0.0},
             Material::grass);
  }
  for (const double x : {-0.5 * half, 0.5 * half}) {
    add_frustum(mesh, {x, 0, -1.0}, {x, 0, deck}, 0.45, 0.45, 18, Material::concrete);
  }
  add_box(mesh, {-half, -half_width_m - 8.0, deck}, {half, half_width_m + 8.0, deck + 1.1},
          Material::concrete);
  for (const double x : {-half, half}) {
    add_box(mesh, {x - 0.1, -half_width_m - 8.0, deck + 1.1},
            {x + 0.1, half_width_m + 8.0, deck + 2.2}, Material::metal);
  }
  return mesh;
}

Mesh make_road_sign(Random& random) {
  Mesh mesh;
  const double w = random.uniform(0.6, 1.8), low = random.uniform(1.2, 2.2),
               h = random.uniform(0.7, 2.0);
  for (const double y : {-0.7 * w, 0.7 * w}) {
    add_frustum(mesh, {0, y, -0.5}, {0, y, low + h}, 0.05, 0.05, 10, Material::metal);
  }
  add_box(mesh, {-0.1, -w, low}, {-0.06, w, low + h}, Material::retro);
  return mesh;
}

}  // namespace lilo::sim
