#include "core/tracking/tracker.hpp"

#include <algorithm>

/// How the tracker's map grows and forgets.
namespace lilo::core {

bool Tracker::is_young(const Solution& solution) const {
  // One scan of an open country fills few cells with enough points; standing still adds them.
  constexpr double kKnowsEnough = 0.5;
  return keyframes_ < kYoung && solution.matched < kKnowsEnough * solution.asked;
}

void Tracker::grow_map(const Timing& scan, const std::vector<Feature>& features,
                       const Solution& solution) {
  const DefaultConfig& c = config_.default_profile;
  maps_.forget_beyond(T_odom_sensor_.translation_m, c.map_radius_m);
  const bool lost = status_ == TrackingStatus::lost;
  if (held_.waiting) {
    // The end of a scan is seen from one side only, by itself; this scan has seen the other.
    if ((scan.motion_compensated || follows(scan, held_.end_ns)) && !lost) {
      held_.trajectory.knots.tail<kKnotSize>() += solution.trajectory.knots.head<kKnotSize>();
    }
    insert_held();
  }
  if (lost || !is_explained_) return;
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
  drift_.inherit(alignment_covariance(), T_odom_sensor_.rotation, keyframes_);
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
  points_.clear();
  for (const Feature& f : held_.features) {
    points_.push_back(
        {sampled_.turn(f.s, {f.x_m, f.y_m, f.z_m}).cast<double>() + sampled_.origin_m(f.s),
         sampled_.turn(f.s, {f.dx_m, f.dy_m, f.dz_m}), f.kind});
  }
  maps_.insert(points_, finest_);
  maps_.end_keyframe();
}

std::vector<Eigen::Vector3f> Tracker::map_points() const {
  std::vector<Eigen::Vector3f> points_m;
  points_m.reserve(static_cast<std::size_t>(maps_.size()));
  maps_.for_each_mean([&](const Eigen::Vector3d& mean_m) {
    points_m.emplace_back((T_odom_start_ * mean_m).cast<float>());
  });
  return points_m;
}

}  // namespace lilo::core
