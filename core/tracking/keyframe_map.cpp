// SPDX-License-Identifier: BSD-3-Clause
#include "core/tracking/keyframe_map.hpp"

#include "core/constants.hpp"
#include "core/image/selection.hpp"

#include <array>

namespace lilo::core {
namespace {

LocalMaps make_cells(const DefaultConfig& c) {
  const auto map = [&](FeatureKind kind, double cell_m, int capacity) {
    return CellMapConfig{.cell_m = static_cast<float>(cell_m),
                         .noise_m = static_cast<float>(c.noise_m),
                         .level = kind == FeatureKind::ground,
                         .with_sensitivity = c.calibrate_beams && cell_m == c.cell_m,
                         .capacity = capacity};
  };
  const auto level = [&](double cell_m, int capacity) {
    return std::array{map(FeatureKind::ground, cell_m, capacity),
                      map(FeatureKind::structure, cell_m, capacity)};
  };
  // A coarse cell is as wide as what a distribution of the usual ones spans. Cells of a surface
  // grow fewer with the square of their size; a quarter leaves room.
  return LocalMaps({level(0.5 * c.cell_m, c.map_cells / 4), level(c.cell_m, c.map_cells),
                    level(3.0 * c.cell_m, c.map_cells / 4)});
}

}  // namespace

KeyframeMap::KeyframeMap(const DefaultConfig& config)
    : config_(config), cells_(make_cells(config)) {
  const auto most = static_cast<std::size_t>(config.map_features);
  held_.features.reserve(most);
  points_.reserve(most);
}

void KeyframeMap::clear() {
  ++revision_;
  cells_.clear();
  held_.is_waiting = false;
  T_odom_keyframe_ = {};
  keyframes_ = 0;
  points_.clear();
}

void KeyframeMap::begin(const std::vector<Feature>& features, const Trajectory& trajectory,
                        std::size_t finest_level) {
  clear();
  hold(features, true);  // outside rooms none of them is overhead
  held_.trajectory = trajectory;
  held_.finest_level = finest_level;
  insert_held();
  keyframes_ = 1;
}

bool KeyframeMap::grow(const AlignedScan& scan) {
  points_.clear();
  cells_.forget_beyond(scan.T_odom_sensor.translation_m, config_.map_radius_m);
  if (held_.is_waiting) {
    const bool continues = scan.timing.motion_compensated || scan.timing.follows(held_.end_ns);
    if (continues && scan.use != MapUse::none) {
      held_.trajectory.knots.tail<kKnotSize>() += scan.solution.trajectory.knots.head<kKnotSize>();
    }
    insert_held();
  }
  if (scan.use != MapUse::keyframe || !is_due(scan)) return false;
  hold(scan.features, scan.is_room);
  held_.trajectory = scan.solution.trajectory;
  held_.end_ns = scan.timing.end_ns;
  held_.finest_level = scan.finest_level;
  // A young map cannot wait for the next scan.
  if (keyframes_ < tracking::kYoungMap) insert_held();
  ++keyframes_;
  T_odom_keyframe_ = scan.T_odom_sensor;
  return true;
}

/// When the sensor has moved: less far in rooms and while the map is young. And while the map has
/// too few cells with enough points, as after one scan in open country. A stationary sensor adds
/// points to them.
bool KeyframeMap::is_due(const AlignedScan& scan) const {
  if (keyframes_ == 0) return true;
  const Solution& solution = scan.solution;
  const bool matched_enough = solution.matched >= tracking::kMatchedEnough * solution.looked_up;
  if (keyframes_ < tracking::kYoungMap && !matched_enough) return true;
  const bool close = scan.is_room || keyframes_ < tracking::kYoungMap;
  const double apart_m = (close ? tracking::kCloseKeyframes : 1.0) * config_.keyframe_m;
  const Pose moved_by = T_odom_keyframe_.inverse() * scan.T_odom_sensor;
  return moved_by.translation_m.norm() >= apart_m ||
         so3_log(moved_by.rotation).norm() >= config_.keyframe_rad;
}

void KeyframeMap::hold(const std::vector<Feature>& features, bool with_overhead) {
  // In an abrupt turn after the start, near points hold the pose. Later the near cells are full,
  // and far points hold the attitude.
  const Evenly evenly = keyframes_ < tracking::kYoungMap ? Evenly::in_image : Evenly::along_rings;
  thin_out(features, static_cast<std::size_t>(config_.map_features), evenly, held_.features,
           with_overhead);
  held_.sensitivity = sensitivity_;
  held_.is_waiting = true;
}

void KeyframeMap::insert_held() {
  ++revision_;
  held_.is_waiting = false;
  sample(held_.trajectory, sampled_);
  points_.clear();
  for (const Feature& f : held_.features) {
    const Eigen::Vector3f turned_m = sampled_.turn(f.s, {f.x_m, f.y_m, f.z_m});
    LocalMaps::Point point{turned_m.cast<double>() + sampled_.origin_m(f.s),
                           sampled_.turn(f.s, {f.dx_m, f.dy_m, f.dz_m}), f.kind,
                           turned_m.normalized()};
    if (config_.calibrate_beams) {
      point.sensitivity =
          sampled_.turn_columns(f.s, moved_by_beams(f, held_.sensitivity.correction)) +
          held_.sensitivity.pose.at(point.point_m);
    }
    points_.push_back(point);
  }
  cells_.insert(points_, held_.finest_level);
  cells_.end_keyframe();
}

void KeyframeMap::subtract_sensitivity(const PoseSensitivity& rigid) {
  cells_.subtract_sensitivity(rigid);
  PoseSensitivity& held = held_.sensitivity.pose;
  held.moved -= rigid.expressed_at(held.place_m).moved;
}

}  // namespace lilo::core
