// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/mesh.hpp"
#include "tools/sim/terrain.hpp"

#include <unordered_map>
#include <vector>

namespace lilo::sim {

/// A piece of road whose curvature (1/m, left is positive) runs linearly between its ends.
struct RouteSegment {
  double length_m = 0.0;
  double curvature_begin = 0.0, curvature_end = 0.0;
};

struct RoutePoint {
  double x = 0.0, y = 0.0;
  double yaw_rad = 0.0;  ///< continuous along the route
  double curvature = 0.0;

  /// The point `left_m` to the left of it (negative: to the right).
  [[nodiscard]] Vec3 beside(double left_m, double z = 0.0) const;
};

/// The line that a world is laid out along and that the sensor drives. Starts with heading 0 at
/// arc length `-lead_m`; what moves starts at arc length 0, which is the origin of x and y.
class Route {
 public:
  Route(const std::vector<RouteSegment>& segments, double lead_m);

  [[nodiscard]] double begin_m() const { return -lead_m_; }
  [[nodiscard]] double end_m() const;
  /// Point at an arc length; straight on beyond the ends.
  [[nodiscard]] RoutePoint at(double arc_m) const;
  /// Distance from (x, y) to the route, at most `limit_m` (which is at most kReach_m).
  [[nodiscard]] double distance(double x, double y, double limit_m) const;
  /// The box around the route, grown by `margin_m`.
  [[nodiscard]] Extent extent(double margin_m) const;

  static constexpr double kReach_m = 40.0;

 private:
  void index_points();

  double lead_m_;
  std::vector<RoutePoint> points_;  ///< every kStep_m
  std::unordered_map<long, std::vector<std::size_t>> buckets_;
};

}  // namespace lilo::sim
