// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sim/route.hpp"

#include "tools/sim/random.hpp"

#include <algorithm>
#include <cmath>

namespace lilo::sim {
namespace {

constexpr double kStep_m = 0.25;
constexpr double kBucket_m = 20.0;

long bucket(long i, long j) { return i * 1000003L + j; }
long bucket_of(double v) { return static_cast<long>(std::floor(v / kBucket_m)); }

}  // namespace

Vec3 RoutePoint::beside(double left_m, double z) const {
  const SinCos heading = sin_cos(yaw_rad);
  return {x - left_m * heading.sin, y + left_m * heading.cos, z};
}

Route::Route(const std::vector<RouteSegment>& segments, double lead_m) : lead_m_(lead_m) {
  points_.push_back({});
  for (const RouteSegment& segment : segments) {
    const int steps = std::max(1, static_cast<int>(std::round(segment.length_m / kStep_m)));
    for (int k = 0; k < steps; ++k) {
      const double s = (k + 0.5) / steps;
      const double curvature =
          segment.curvature_begin + s * (segment.curvature_end - segment.curvature_begin);
      const RoutePoint& last = points_.back();
      const double turn = curvature * kStep_m;
      const SinCos middle = sin_cos(last.yaw_rad + 0.5 * turn);
      points_.push_back({last.x + kStep_m * middle.cos, last.y + kStep_m * middle.sin,
                         last.yaw_rad + turn, curvature});
    }
  }
  const RoutePoint origin = at(0.0);
  for (RoutePoint& p : points_) {
    p.x -= origin.x;
    p.y -= origin.y;
  }
  index_points();
}

void Route::index_points() {
  for (std::size_t k = 0; k < points_.size(); ++k) {
    buckets_[bucket(bucket_of(points_[k].x), bucket_of(points_[k].y))].push_back(k);
  }
}

double Route::end_m() const { return static_cast<double>(points_.size() - 1) * kStep_m - lead_m_; }

RoutePoint Route::at(double arc_m) const {
  const double u = (arc_m + lead_m_) / kStep_m;
  const auto last = static_cast<double>(points_.size() - 2);
  const auto index = static_cast<std::size_t>(std::clamp(std::floor(u), 0.0, last));
  const double s = u - static_cast<double>(index);
  const RoutePoint& a = points_[index];
  const RoutePoint& b = points_[index + 1];
  RoutePoint p{a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), a.yaw_rad, a.curvature};
  const double inside = std::clamp(s, 0.0, 1.0);  // beyond the ends the heading stays
  p.yaw_rad += inside * (b.yaw_rad - a.yaw_rad);
  p.curvature += inside * (b.curvature - a.curvature);
  return p;
}

double Route::distance(double x, double y, double limit_m) const {
  double best = limit_m * limit_m;
  for (long j = bucket_of(y - limit_m); j <= bucket_of(y + limit_m); ++j) {
    for (long i = bucket_of(x - limit_m); i <= bucket_of(x + limit_m); ++i) {
      const auto found = buckets_.find(bucket(i, j));
      if (found == buckets_.end()) continue;
      for (const std::size_t k : found->second) {
        const double dx = points_[k].x - x, dy = points_[k].y - y;
        const double squared = dx * dx + dy * dy;
        if (squared >= best) continue;
        best = squared;
        // Across the line the nearest sample alone would make a saw-tooth of the distance.
        const SinCos heading = sin_cos(points_[k].yaw_rad);
        const double along = dx * heading.cos + dy * heading.sin;
        if (std::abs(along) < kStep_m) best = squared - along * along;
      }
    }
  }
  return std::sqrt(best);
}

Extent Route::extent(double margin_m) const {
  Extent box{1e30, 1e30, -1e30, -1e30};
  for (const RoutePoint& p : points_) {
    box.x_low = std::min(box.x_low, p.x - margin_m);
    box.x_high = std::max(box.x_high, p.x + margin_m);
    box.y_low = std::min(box.y_low, p.y - margin_m);
    box.y_high = std::max(box.y_high, p.y + margin_m);
  }
  return box;
}

}  // namespace lilo::sim
