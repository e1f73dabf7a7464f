#include "core/standard/tracker.hpp"

#include <algorithm>
#include <array>

/// How the tracker's map grows and forgets.
namespace lilo::standard {

bool Tracker::is_young(const Solution& solution) const {
  // One scan of an open country fills few cells with enough points; standing still adds them.
  constexpr double kKnowsEnough = 0.5;
  return keyframes_ < kYoung && solution.matched < kKnowsEnough * solution.asked;
}

void Tracker::grow_map(const Timing& scan, const std::vector<Feature>& features,
                       const Solution& solution) {
  const StandardConfig& c = config_.standard;
  maps_.forget_beyond(T_odom_sensor_.translation_m, c.map_radius_m);
  const bool lost = status_ == TrackingStatus::lost;
  if (held_.waiting) {
    // The end of a scan is seen from one side only, by itself; this scan has seen the other.
    if ((scan.motion_compensated || follows(scan, held_.end_ns)) && !lost) {
      held_.trajectory.knots.tail<kKnotSize>() += solution.trajectory.knots.head<kKnotSize>();
    }
    insert_held();
  }
  if (lost) return;
  const Pose moved_by = T_odom_keyframe_.inverse() * T_odom_sensor_;
  if (scan_count_ > 0 && !is_young(solution) && moved_by.translation_m.norm() < c.keyframe_m &&
      so3_log(moved_by.rotation).norm() < c.keyframe_rad) {
    return;
  }
  hold(features, solution.trajectory, scan.end_ns);
  // While there is little else, a scan late is too late.
  if (keyframes_ < kYoung) insert_held();
  ++keyframes_;
  T_odom_keyframe_ = T_odom_sensor_;
  drift_.inherit(alignment_covariance(), keyframes_);
}

void Tracker::hold(const std::vector<Feature>& features, const Trajectory& trajectory,
                   std::int64_t end_ns) {
  thin_out(features, for_map(), held_.features);
  held_.trajectory = trajectory;
  held_.end_ns = end_ns;
  held_.waiting = true;
}

void Tracker::insert_held() {
  held_.waiting = false;
  sample(held_.trajectory, sampled_);
  // Some at a time, so that the memory's answers overlap.
  struct Waiting {
    Eigen::Vector3d point_m;
    CellMap::Place fine, coarse;
    std::int32_t fine_cell, coarse_cell;
  };
  std::array<Waiting, 16> waiting;
  for (std::size_t first = 0; first < held_.features.size(); first += waiting.size()) {
    const std::size_t n = std::min(waiting.size(), held_.features.size() - first);
    for (std::size_t k = 0; k < n; ++k) {
      const Feature& f = held_.features[first + k];
      Waiting& one = waiting[k];
      one.point_m =
          sampled_.turn(f.s, {f.x_m, f.y_m, f.z_m}).cast<double>() + sampled_.origin_m(f.s);
      one.fine = maps_.fine(f.kind).place_of(one.point_m);
      one.coarse = maps_.coarse(f.kind).place_of(one.point_m);
    }
    for (std::size_t k = 0; k < n; ++k) {
      const Kind kind = held_.features[first + k].kind;
      waiting[k].fine_cell = maps_.fine(kind).open(waiting[k].fine);
      waiting[k].coarse_cell = maps_.coarse(kind).open(waiting[k].coarse);
    }
    for (std::size_t k = 0; k < n; ++k) {
      const Feature& f = held_.features[first + k];
      const Waiting& one = waiting[k];
      const CellMap::Reach reach(sampled_.turn(f.s, {f.dx_m, f.dy_m, f.dz_m}));
      maps_.fine(f.kind).add(one.fine_cell, one.fine, one.point_m, reach);
      maps_.coarse(f.kind).add(one.coarse_cell, one.coarse, one.point_m, reach);
    }
  }
  maps_.end_keyframe();
}

std::vector<Eigen::Vector3f> Tracker::map_points() const {
  std::vector<Eigen::Vector3f> points_m;
  points_m.reserve(static_cast<std::size_t>(maps_.ground_fine.size()) +
                   static_cast<std::size_t>(maps_.structure_fine.size()));
  const auto append = [&](const Eigen::Vector3d& mean_m) {
    points_m.emplace_back((T_odom_start_ * mean_m).cast<float>());
  };
  maps_.ground_fine.for_each_mean(append);
  maps_.structure_fine.for_each_mean(append);
  return points_m;
}

}  // namespace lilo::standard
