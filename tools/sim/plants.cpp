// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/plants.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lilo::sim {
namespace {

Vec3 random_direction(Random& random) {
  const double z = random.uniform(-1.0, 1.0), r = std::sqrt(1.0 - z * z);
  const SinCos a = sin_cos(random.angle());
  return {r * a.cos, r * a.sin, z};
}

/// A leaf, or a spray of leaves that a 3 mrad beam cannot tell apart, in any attitude.
void add_leaf(Mesh& mesh, Random& random, const Vec3& at, double size_m) {
  add_triangle(mesh, at + size_m * random_direction(random), at + size_m * random_direction(random),
               at + size_m * random_direction(random), Material::leaf);
}

/// Leaves through an ellipsoid, denser towards its skin, where the light is.
void add_foliage(Mesh& mesh, Random& random, const Vec3& centre, const Vec3& radii, int leaves,
                 double size_m) {
  for (int k = 0; k < leaves; ++k) {
    const double depth = std::sqrt(random.uniform(0.15, 1.0));
    const Vec3 at = centre + depth * radii.cwiseProduct(random_direction(random));
    add_leaf(mesh, random, at, size_m * random.uniform(0.5, 1.5));
  }
}

/// A limb that bends at random as it goes; returns where it ends.
Vec3 add_limb(Mesh& mesh, Random& random, Vec3 from, Vec3 direction, double length_m,
              double radius_m, int pieces, double bend) {
  for (int k = 0; k < pieces; ++k) {
    const double r0 = radius_m * (1.0 - 0.7 * k / pieces);
    const double r1 = radius_m * (1.0 - 0.7 * (k + 1) / pieces);
    const Vec3 to = from + direction * (length_m / pieces);
    add_frustum(mesh, from, to, r0 * random.uniform(0.9, 1.1), r1, radius_m > 0.1 ? 10 : 6,
                Material::bark);
    from = to;
    direction = (direction + bend * random_direction(random)).normalized();
  }
  return from;
}

struct Skeleton {
  std::vector<Vec3> tips;
  double height_m;
};

Skeleton add_skeleton(Mesh& mesh, Random& random) {
  const double height = random.uniform(5.0, 13.0);
  const double radius = 0.012 * height * random.uniform(0.8, 1.8);
  const double bole = height * random.uniform(0.25, 0.45);
  // Roots spread at the foot.
  add_frustum(mesh, {0.0, 0.0, -0.4}, {0.0, 0.0, 0.35}, 1.6 * radius, 1.05 * radius, 10,
              Material::bark);
  const Vec3 lean =
      (Vec3(0.0, 0.0, 1.0) + random.uniform(0.0, 0.1) * random_direction(random)).normalized();
  const Vec3 crown = add_limb(mesh, random, {0.0, 0.0, -0.2}, lean, bole + 0.2, radius, 4, 0.06);
  Skeleton skeleton{{}, height};
  const int branches = 5 + random.below(6);
  for (int k = 0; k < branches; ++k) {
    const SinCos around =
        sin_cos(2.0 * std::numbers::pi * (k + random.uniform(-0.4, 0.4)) / branches);
    const double rise = random.uniform(0.3, 2.2);
    const Vec3 direction = Vec3(around.cos, around.sin, rise).normalized();
    const double length = (height - bole) * random.uniform(0.4, 0.8);
    const Vec3 tip = add_limb(mesh, random, crown - Vec3(0.0, 0.0, random.uniform(0.0, 0.2 * bole)),
                              direction, length, radius * random.uniform(0.35, 0.6), 3, 0.25);
    skeleton.tips.push_back(tip);
    for (int twig = 0; twig < 3; ++twig) {
      skeleton.tips.push_back(add_limb(mesh, random,
                                       crown + (tip - crown) * random.uniform(0.4, 0.9),
                                       (direction + 0.8 * random_direction(random)).normalized(),
                                       length * random.uniform(0.3, 0.5), 0.02, 2, 0.3));
    }
  }
  skeleton.tips.push_back(
      add_limb(mesh, random, crown, lean, 0.8 * (height - bole), 0.5 * radius, 3, 0.15));
  return skeleton;
}

}  // namespace

Mesh make_broadleaf_tree(Random& random) {
  Mesh mesh;
  const Skeleton skeleton = add_skeleton(mesh, random);
  const double density = random.uniform(0.6, 1.4);
  for (const Vec3& tip : skeleton.tips) {
    const double r = skeleton.height_m * random.uniform(0.06, 0.16);
    const Vec3 radii(r * random.uniform(0.8, 1.3), r * random.uniform(0.8, 1.3),
                     r * random.uniform(0.6, 1.0));
    add_foliage(mesh, random, tip, radii, static_cast<int>(90.0 * density),
                random.uniform(0.08, 0.16));
  }
  return mesh;
}

Mesh make_street_tree(Random& random) {
  Mesh mesh = make_broadleaf_tree(random);
  std::erase_if(mesh, [](const Triangle& t) {
    return t.material == Material::leaf && std::min({t.a.z(), t.b.z(), t.c.z()}) < 2.8F;
  });
  return mesh;
}

Mesh make_bare_tree(Random& random) {
  Mesh mesh;
  const Skeleton skeleton = add_skeleton(mesh, random);
  for (const Vec3& tip : skeleton.tips) {
    for (int k = 0; k < 4; ++k)
      add_limb(mesh, random, tip, random_direction(random), 0.7, 0.012, 2, 0.3);
  }
  return mesh;
}

Mesh make_conifer(Random& random) {
  Mesh mesh;
  const double height = random.uniform(5.0, 14.0),
               radius = 0.011 * height * random.uniform(0.8, 1.4);
  add_limb(mesh, random, {0.0, 0.0, -0.3}, {0.0, 0.0, 1.0}, height + 0.3, radius, 5, 0.02);
  const double skirt = random.uniform(0.15, 2.0), reach = height * random.uniform(0.14, 0.24);
  const int tiers = static_cast<int>(height * 1.6);
  for (int t = 0; t < tiers; ++t) {
    const double z = skirt + (height - skirt) * t / tiers;
    const double r = reach * (1.0 - (z - skirt) / (height - skirt)) + 0.15;
    for (int k = 0; k < 7; ++k) {
      const SinCos a = sin_cos(random.angle());
      const double out = r * random.uniform(0.5, 1.0);
      const Vec3 tip(out * a.cos, out * a.sin, z - 0.25 * out);
      add_foliage(mesh, random, 0.6 * tip + Vec3(0.0, 0.0, 0.4 * z),
                  {0.45 * out + 0.05, 0.45 * out + 0.05, 0.12}, 14, 0.09);
    }
  }
  return mesh;
}

Mesh make_bush(Random& random) {
  Mesh mesh;
  const double height = random.uniform(0.6, 1.8);
  const int blobs = 2 + random.below(4);
  for (int k = 0; k < blobs; ++k) {
    const double r = height * random.uniform(0.3, 0.55);
    const Vec3 centre(random.uniform(-0.6, 0.6) * height, random.uniform(-0.6, 0.6) * height,
                      random.uniform(0.3, 0.6) * height);
    add_foliage(mesh, random, centre, {r, r * random.uniform(0.7, 1.3), r}, 140,
                random.uniform(0.04, 0.08));
    add_limb(mesh, random, {0.0, 0.0, -0.1}, (centre + Vec3(0.0, 0.0, 0.3)).normalized(),
             centre.norm(), 0.02, 2, 0.2);
  }
  return mesh;
}

Mesh make_grass_tuft(Random& random) {
  Mesh mesh;
  const double height = random.uniform(0.08, 0.4);
  for (int k = 0; k < 14; ++k) {
    const Vec3 foot(random.uniform(-0.18, 0.18), random.uniform(-0.18, 0.18), -0.05);
    const Vec3 tip = foot + height * (Vec3(0.0, 0.0, 1.0) + 0.6 * random_direction(random));
    const SinCos a = sin_cos(random.angle());
    add_triangle(mesh, foot, foot + 0.03 * Vec3(a.cos, a.sin, 0.0), tip, Material::leaf);
  }
  return mesh;
}

Mesh make_hedge(Random& random, double length_m) {
  Mesh mesh;
  const double height = random.uniform(0.7, 1.8), half = random.uniform(0.25, 0.5);
  for (double x = 0.0; x < length_m; x += 0.5) {
    const double h = height * random.uniform(0.85, 1.1);
    add_foliage(mesh, random, {x + 0.25, random.uniform(-0.06, 0.06), 0.5 * h},
                {0.4, half, 0.55 * h}, 90, 0.06);
  }
  return mesh;
}

}  // namespace lilo::sim
