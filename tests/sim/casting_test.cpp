// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/noise_field.hpp"
#include "tools/sim/random.hpp"
#include "tools/sim/scene.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lilo::sim {
namespace {

Vec3 direction(Random& random) {
  return Vec3(random.normal(), random.normal(), random.normal()).normalized();
}

Mesh random_triangles(Random& random, int count) {
  Mesh mesh;
  for (int k = 0; k < count; ++k) {
    const Vec3 at(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-5, 5));
    add_triangle(mesh, at, at + direction(random), at + direction(random), Material::leaf);
  }
  return mesh;
}

double nearest_of_all(const Mesh& mesh, const Ray& ray, double limit) {
  double nearest = limit;
  for (const Triangle& t : mesh) {
    nearest = std::min(nearest,
                       intersect(ray, t.a.cast<double>(), t.b.cast<double>(), t.c.cast<double>()));
  }
  return nearest;
}

TEST(Casting, TreeFindsWhatTryingEveryTriangleFinds) {
  Random random(1);
  const Mesh mesh = random_triangles(random, 3000);
  const SolidMesh solid(mesh);
  int hits = 0;
  for (int k = 0; k < 2000; ++k) {
    const Ray ray(Vec3(random.uniform(-25, 25), random.uniform(-25, 25), random.uniform(-6, 6)),
                  direction(random));
    Hit hit{60.0};
    solid.cast(ray, hit);
    EXPECT_DOUBLE_EQ(hit.range_m, nearest_of_all(mesh, ray, 60.0));
    hits += hit.found ? 1 : 0;
  }
  EXPECT_GT(hits, 200);
}

TEST(Casting, TriangleIsMetWhereItsPlaneIs) {
  Random random(2);
  for (int k = 0; k < 1000; ++k) {
    const Vec3 a = 10.0 * direction(random), b = 10.0 * direction(random),
               c = 10.0 * direction(random);
    const Vec3 target = (a + b + c) / 3.0, origin = 30.0 * direction(random);
    const Ray ray(origin, (target - origin).normalized());
    EXPECT_NEAR(intersect(ray, a, b, c), (target - origin).norm(), 1e-9);
    const Vec3 outside = a + 1.01 * (b - a) + 0.1 * (b - c);
    EXPECT_EQ(intersect(Ray(origin, (outside - origin).normalized()), a, b, c), Box::kMiss);
  }
}

TEST(Casting, TerrainHitsLieOnTheTerrainAndNothingIsInTheWay) {
  const Fractal hills{5, 20.0, 3.0, 4, 0.5};
  const Terrain terrain({-60, -45, 61, 52}, 0.5, [&](double x, double y) -> Terrain::Sample {
    return {hills(x, y), Material::grass};
  });
  Random random(3);
  int hits = 0;
  for (int k = 0; k < 3000; ++k) {
    const double x = random.uniform(-50, 50), y = random.uniform(-40, 45);
    const Vec3 origin(x, y, terrain.height(x, y) + random.uniform(0.3, 3.0));
    Vec3 along = direction(random);
    along.z() = std::min(0.15, 0.3 * along.z());
    along.normalize();
    Hit hit{80.0};
    terrain.cast(Ray(origin, along), hit);
    // Walk along the ray: above the ground up to the hit.
    for (double r = 0.01; r < hit.range_m - 0.01; r += 0.05) {
      const Vec3 p = origin + r * along;
      if (p.x() < -60 || p.x() > 60.5 || p.y() < -45 || p.y() > 51.5) break;
      ASSERT_GT(p.z() - terrain.height(p.x(), p.y()), -1e-4);
    }
    if (!hit.found) continue;
    ++hits;
    const Vec3 p = origin + hit.range_m * along;
    EXPECT_NEAR(p.z(), terrain.height(p.x(), p.y()), 1e-6);
  }
  EXPECT_GT(hits, 800);
}

TEST(Casting, InstancesAreTheirShapeMovedTurnedAndScaled) {
  Random random(4);
  const Mesh mesh = random_triangles(random, 200);
  Placement placement = place({3.0, -2.0, 1.0}, 0.7, 1.6);
  Mesh moved;
  append(moved, mesh, placement);
  Scene scene;
  scene.add_instance(scene.add_shape(mesh), placement);
  scene.finish();
  int hits = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vec3 origin = 50.0 * direction(random),
               along = (20.0 * direction(random) - origin).normalized();
    const Hit hit = scene.cast(origin, along, 0.0, 100.0);
    // The copy's corners are rounded to floats, so edges may differ by a micrometre.
    const double expected = nearest_of_all(moved, Ray(origin, along), 100.0);
    if (!hit.found || expected >= 100.0) continue;
    EXPECT_NEAR(hit.range_m, expected, 1e-3);
    ++hits;
  }
  EXPECT_GT(hits, 50);
}

TEST(Casting, MoversAreWhereTheirMotionPutsThemAtThatInstant) {
  Mesh box;
  add_box(box, {-1, -1, -1}, {1, 1, 1}, Material::paint);
  Scene scene;
  Mover mover{scene.add_shape(box), {}};
  for (int k = 0; k <= 200; ++k) {  // 5 m/s along x, from x = 10
    mover.states.push_back({{10.0 + 5.0 * k * kMoverStep_s, 0.0, 0.0}, 0.0, 0.0});
  }
  scene.add_mover(mover);
  scene.finish();
  for (const double time : {0.0, 0.1234567, 1.0, 1.7}) {
    const Hit hit = scene.cast({0, 0, 0}, {1, 0, 0}, time, 100.0);
    ASSERT_TRUE(hit.found);
    EXPECT_NEAR(hit.range_m, 9.0 + 5.0 * time, 1e-9);
  }
}

}  // namespace
}  // namespace lilo::sim
