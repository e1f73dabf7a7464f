// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/planting.hpp"

#include "tools/sim/noise_field.hpp"

#include <cmath>
#include <numbers>

namespace lilo::sim {

void Planter::plant(const ShapeSet& set, double x, double y) {
  Placement placement =
      place({x, y, scene_.terrain.height(x, y)}, random_.angle(), random_.uniform(0.75, 1.25));
  const SinCos lean = sin_cos(0.05 * random_.normal());
  Eigen::Matrix3d tilt;
  tilt << lean.cos, 0.0, lean.sin, 0.0, 1.0, 0.0, -lean.sin, 0.0, lean.cos;
  placement.rotation = placement.rotation * tilt;
  scene_.add_instance(set.any(random_), placement);
}

void Planter::stand(const ShapeSet& set, double arc_m, double left_m, double yaw_rad) {
  const RoutePoint p = route_.at(arc_m);
  const Vec3 at = p.beside(left_m);
  // Where the route bends back on itself, the place may lie on it.
  if (route_.distance(at.x(), at.y(), std::abs(left_m) + 1.0) < 0.9 * std::abs(left_m) - 0.1)
    return;
  scene_.add_instance(set.any(random_),
                      place({at.x(), at.y(), scene_.terrain.height(at.x(), at.y())},
                            p.yaw_rad + yaw_rad + 0.03 * random_.normal()));
}

void Planter::scatter(const ShapeSet& set, const Extent& extent, double per_square_m,
                      double clearance_m, double farthest_m) {
  const double area = (extent.x_high - extent.x_low) * (extent.y_high - extent.y_low);
  const auto tries = static_cast<int>(2.0 * area * per_square_m);
  const std::uint64_t seed = random_.next();
  for (int k = 0; k < tries; ++k) {
    const double x = random_.uniform(extent.x_low, extent.x_high);
    const double y = random_.uniform(extent.y_low, extent.y_high);
    const double keep = 0.5 + 1.2 * gradient_noise(seed, x / 17.0, y / 17.0);
    if (!random_.chance(keep)) continue;
    const double reach = farthest_m < 1e8 ? farthest_m : clearance_m;
    const double distance = route_.distance(x, y, reach);
    if (distance < clearance_m || (farthest_m < 1e8 && distance >= farthest_m)) continue;
    plant(set, x, y);
  }
}

std::vector<RouteSegment> winding(Random& random, double length_m, double shortest_m,
                                  double longest_m, double curvature) {
  std::vector<RouteSegment> segments;
  double done = 0.0, last = 0.0, heading = 0.0;
  while (done < length_m) {
    const double length = random.uniform(shortest_m, longest_m);
    // Turns back towards heading zero the more the farther it has turned away: the route does not
    // close on itself.
    const double home = -heading / (2.0 * longest_m);
    double next = std::clamp(random.uniform(-curvature, curvature) + home, -curvature, curvature);
    if (random.chance(0.2)) next = 0.0;
    segments.push_back({length, last, next});
    heading += 0.5 * (last + next) * length;
    last = next;
    done += length;
  }
  segments.push_back({20.0, last, 0.0});
  return segments;
}

}  // namespace lilo::sim
