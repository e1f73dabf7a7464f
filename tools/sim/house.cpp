// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/house.hpp"

#include <algorithm>
#include <cmath>

namespace lilo::sim {
namespace {

/// What one house's front has in common.
struct Style {
  double width_m, depth_m;
  double floor_height_m, plinth_m;
  int floors, columns;
  double window_width, window_height;  ///< parts of the column's and floor's size
  double recess_m;
  bool shop, balconies;
  Material wall;
};

Style make_style(Random& random, double width_m) {
  Style style{};
  style.width_m = width_m;
  style.depth_m = random.uniform(7.0, 13.0);
  style.floors = 2 + random.below(4);
  style.floor_height_m = random.uniform(2.6, 3.6);
  style.plinth_m = random.uniform(0.0, 0.7);
  style.columns = std::max(1, static_cast<int>(width_m / random.uniform(2.2, 3.8)));
  style.window_width = random.uniform(0.3, 0.6);
  style.window_height = random.uniform(0.4, 0.65);
  style.recess_m = random.uniform(0.06, 0.32);
  style.shop = random.chance(0.3);
  style.balconies = random.chance(0.35);
  style.wall = random.chance(0.5) ? Material::plaster : Material::brick;
  return style;
}

struct Opening {
  double x0, x1, z0, z1;
};

/// A piece of wall with one hole, the hole's four reveals and what closes it.
void add_bay(Mesh& mesh, const Style& style, double x0, double x1, double z0, double z1,
             const Opening& hole, double recess_m, Material pane) {
  const auto wall = [&](double a, double b, double c, double d) {
    if (b > a && d > c) add_quad(mesh, {a, 0, c}, {b - a, 0, 0}, {0, 0, d - c}, style.wall);
  };
  wall(x0, x1, z0, hole.z0);
  wall(x0, x1, hole.z1, z1);
  wall(x0, hole.x0, hole.z0, hole.z1);
  wall(hole.x1, x1, hole.z0, hole.z1);
  const double w = hole.x1 - hole.x0, h = hole.z1 - hole.z0;
  const Vec3 inward(0, recess_m, 0);
  add_quad(mesh, {hole.x0, 0, hole.z0}, inward, {w, 0, 0}, style.wall);
  add_quad(mesh, {hole.x0, 0, hole.z1}, inward, {w, 0, 0}, style.wall);
  add_quad(mesh, {hole.x0, 0, hole.z0}, inward, {0, 0, h}, style.wall);
  add_quad(mesh, {hole.x1, 0, hole.z0}, inward, {0, 0, h}, style.wall);
  add_quad(mesh, {hole.x0, recess_m, hole.z0}, {w, 0, 0}, {0, 0, h}, pane);
}

void add_balcony(Mesh& mesh, Random& random, double x0, double x1, double floor_z) {
  const double out = random.uniform(0.6, 1.4);
  add_box(mesh, {x0, -out, floor_z - 0.15}, {x1, 0.0, floor_z}, Material::concrete);
  for (double x = x0; x < x1; x += 0.14) {
    add_frustum(mesh, {x, -out + 0.03, floor_z}, {x, -out + 0.03, floor_z + 1.0}, 0.012, 0.012, 5,
                Material::metal);
  }
  add_box(mesh, {x0, -out, floor_z + 1.0}, {x1, -out + 0.05, floor_z + 1.05}, Material::metal);
}

void add_front(Mesh& mesh, Random& random, const Style& style) {
  const double column = style.width_m / style.columns;
  const int door = random.below(style.columns);
  for (int f = 0; f < style.floors; ++f) {
    const double z0 = f * style.floor_height_m, z1 = z0 + style.floor_height_m;
    for (int c = 0; c < style.columns; ++c) {
      const double x0 = c * column, x1 = x0 + column, middle = 0.5 * (x0 + x1);
      const double half = 0.5 * style.window_width * column * random.uniform(0.95, 1.05);
      const double sill = z0 + 0.32 * style.floor_height_m;
      Opening hole{middle - half, middle + half, sill,
                   std::min(z1 - 0.15, sill + style.window_height * style.floor_height_m)};
      double recess = style.recess_m * random.uniform(0.8, 1.2);
      Material pane =
          random.chance(0.25) ? Material::paint : Material::glass;  // some shutters are down
      if (f == 0 && c == door) {
        hole = {middle - 0.5, middle + 0.5, 0.02, 2.2};
        recess = random.uniform(0.15, 1.2);
        pane = Material::paint;
      } else if (f == 0 && style.shop) {
        hole = {x0 + 0.12 * column, x1 - 0.12 * column, 0.4, z1 - 0.5};
        recess = random.uniform(0.1, 0.5);
        pane = Material::glass;
      }
      if (half < 0.2 || (f > 0 && random.chance(0.06)))
        hole = {middle, middle, sill, sill};  // blind
      add_bay(mesh, style, x0, x1, z0, z1, hole, recess, pane);
      if (f > 0 && style.balconies && random.chance(0.4)) {
        add_balcony(mesh, random, x0 + 0.2, x1 - 0.2, z0 + 0.05);
      }
    }
    if (f > 0 && random.chance(0.6)) {
      add_box(mesh, {0.0, -random.uniform(0.03, 0.12), z0 - 0.1}, {style.width_m, 0.0, z0 + 0.05},
              style.wall);
    }
  }
}

void add_roof(Mesh& mesh, Random& random, const Style& style, double top) {
  const double w = style.width_m, d = style.depth_m;
  if (random.chance(0.35)) {  // flat, with a parapet
    add_box(mesh, {0.0, -0.05, top}, {w, 0.25, top + random.uniform(0.3, 0.9)}, style.wall);
    add_quad(mesh, {0, 0, top}, {w, 0, 0}, {0, d, 0}, Material::concrete);
    return;
  }
  const double eaves = random.uniform(0.2, 0.7), rise = d * random.uniform(0.25, 0.5);
  add_quad(mesh, {0, -eaves, top - 0.05}, {w, 0, 0}, {0, 0.5 * d + eaves, rise}, Material::brick);
  add_quad(mesh, {0, d + eaves, top - 0.05}, {w, 0, 0}, {0, -0.5 * d - eaves, rise},
           Material::brick);
  for (const double x : {0.0, w}) {
    add_triangle(mesh, {x, 0, top}, {x, d, top}, {x, 0.5 * d, top + rise}, style.wall);
  }
  const double cx = random.uniform(0.2, 0.8) * w;
  add_box(mesh, {cx - 0.4, 0.4 * d, top}, {cx + 0.4, 0.4 * d + 0.7, top + rise + 0.8},
          Material::brick);
  if (random.chance(0.5)) {
    const double gx = random.uniform(0.2, 0.7) * w;
    add_box(mesh, {gx, 0.1 * d, top}, {gx + 1.4, 0.45 * d, top + 0.6 * rise + 0.7}, style.wall);
  }
}

}  // namespace

Mesh make_house(Random& random, double width_m) {
  Mesh mesh;
  const Style style = make_style(random, width_m);
  const double top = style.floors * style.floor_height_m;
  add_front(mesh, random, style);
  // Walls go below the ground: houses stand on slopes.
  add_quad(mesh, {0, 0, -2.0}, {width_m, 0, 0}, {0, 0, 2.0}, style.wall);
  for (const double x : {0.0, width_m}) {
    add_quad(mesh, {x, 0, -2.0}, {0, style.depth_m, 0}, {0, 0, top + 2.0}, style.wall);
  }
  add_quad(mesh, {0, style.depth_m, -2.0}, {width_m, 0, 0}, {0, 0, top + 2.0}, style.wall);
  if (style.plinth_m > 0.1) {
    add_box(mesh, {0.0, -0.06, -0.5}, {width_m, 0.0, 0.4 * style.plinth_m}, Material::concrete);
  }
  const double pipe = random.chance(0.5) ? 0.12 : width_m - 0.12;
  add_frustum(mesh, {pipe, -0.09, -0.2}, {pipe, -0.09, top}, 0.05, 0.05, 8, Material::metal);
  if (random.chance(0.4)) {
    const double x = random.uniform(0.2, 0.7) * width_m;
    add_box(mesh, {x, -random.uniform(0.3, 0.9), -0.3}, {x + random.uniform(0.9, 1.6), 0.0, 0.16},
            Material::concrete);
  }
  add_roof(mesh, random, style, top);
  return mesh;
}

}  // namespace lilo::sim
