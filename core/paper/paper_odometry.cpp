// SPDX-License-Identifier: BSD-3-Clause
#include "core/paper/paper_odometry.hpp"

#include "core/paper/segmentation.hpp"

#include <opencv2/core/utility.hpp>

#include <algorithm>
#include <array>

namespace lilo::paper {
namespace {

Cloud::Ptr surfaces_of(const Features& features, FeatureGroup group) {
  Cloud::Ptr cloud(new Cloud);
  if (group != FeatureGroup::EG) *cloud += *features.surfaces;
  if (group != FeatureGroup::ES) *cloud += *features.ground;
  return cloud;
}

/// The motion of `twist` over dt_s: the pose of the later frame in the earlier one.
Pose motion_of(const Twist& twist, double dt_s) {
  return {so3_exp(dt_s * twist.angular_radps), dt_s * twist.linear_mps};
}

Reduced deskew_all(const Reduced& raw, const Twist& twist, double duration_s) {
  const Pose T_start_end = motion_of(twist, duration_s);
  Reduced deskewed;
  deskew(T_start_end, *raw.edges, *deskewed.edges);
  deskew(T_start_end, *raw.surfaces, *deskewed.surfaces);
  return deskewed;
}

// Of one scan: about a second of work, and 70 times what the simulated street and town take at
// most. Without it, small voxels in a large neighbourhood_m could keep one scan for hours.
constexpr std::int64_t kMostNeighbours = 20'000'000;

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

/// Since the scan before. Longer than a few seconds, and either the clock was set or the sensor was
/// off: then there is no reason to have moved on for all of it.
double time_since(std::int64_t last_end_ns, const Scan& scan) {
  constexpr double kLongestGap_s = 5.0;
  const double dt_s = seconds(scan.end_ns - last_end_ns);
  const double turn_s = seconds(scan.end_ns - scan.start_ns);
  return dt_s > 0.0 && dt_s <= kLongestGap_s ? dt_s : turn_s;
}

}  // namespace

PaperOdometry::PaperOdometry(const OdometryConfig& config)
    : config_(config),
      edge_map_(config.paper.edge_voxel_m, config.paper.map_radius_m),
      surface_map_(config.paper.surface_voxel_m, config.paper.map_radius_m) {
  cv::setNumThreads(1);
}

Estimate PaperOdometry::process(const Scan& scan, StageHook hook) {
  const bool rigid = scan.motion_compensated || config_.paper.deskew == Deskew::none;
  const double duration_s = rigid ? 0.0 : seconds(scan.end_ns - scan.start_ns);
  const double dt_s = time_since(last_end_ns_, scan);

  const RangeImage image = image_of(scan, config_);
  hook(Stage::project);
  const cv::Mat1b labels = segment(image.range_m, config_.paper, scan.beams);
  hook(Stage::filter);
  const Reduced reduced = reduce(reconstruct(scan, image, labels, config_.paper.pixel_centres));
  hook(Stage::reconstruct);
  const Reduced predicted = deskew_all(reduced, twist_, duration_s);
  hook(Stage::deskew);
  const Alignment alignment = align_to_map(predicted, dt_s);
  hook(Stage::align);
  advance(alignment, dt_s);
  // F-LOAM's second stage: the points enter the map deskewed by the motion that was found.
  update_maps(config_.paper.deskew == Deskew::two_stage ? deskew_all(reduced, twist_, duration_s)
                                                        : predicted);
  hook(Stage::update_map);

  last_end_ns_ = scan.end_ns;
  ++scan_count_;
  Estimate result = estimate(scan, alignment);
  result.edge_count = static_cast<int>(reduced.edges->size());
  result.surface_count = static_cast<int>(reduced.surfaces->size());
  return result;
}

std::vector<Eigen::Vector3f> PaperOdometry::map_points() const {
  std::vector<Eigen::Vector3f> points_m;
  points_m.reserve(edge_map_.cloud().size() + surface_map_.cloud().size());
  for (const LocalMap* map : {&edge_map_, &surface_map_}) {
    for (const Point& p : map->cloud()) points_m.emplace_back(p.getVector3fMap());
  }
  return points_m;
}

Reduced PaperOdometry::reduce(const Features& features) const {
  return {voxel_grid(features.edges, config_.paper.edge_voxel_m),
          voxel_grid(surfaces_of(features, config_.paper.group), config_.paper.surface_voxel_m)};
}

Alignment PaperOdometry::align_to_map(const Reduced& scan, double dt_s) const {
  Alignment alignment;
  if (scan_count_ == 0) return alignment;
  alignment.T_odom_sensor = T_odom_sensor_ * motion_of(twist_, dt_s);
  // The sensor may be moving when it is switched on: until a motion is known the guess is off by a
  // whole step, and the search begins wide.
  constexpr std::array<double, 3> kSearch = {3.0, 2.0, 1.0};
  std::int64_t left = kMostNeighbours;
  for (std::size_t k = motion_known() ? kSearch.size() - 1 : 0; k < kSearch.size() && left > 0;
       ++k) {
    alignment =
        paper::align(*scan.edges, *scan.surfaces, edge_map_, surface_map_, alignment.T_odom_sensor,
                     kSearch[k] * config_.paper.neighbourhood_m, config_.paper, left);
  }
  return alignment;
}

void PaperOdometry::advance(const Alignment& alignment, double dt_s) {
  if (scan_count_ == 0 || dt_s <= 0.0) return;
  const Pose motion = T_odom_sensor_.inverse() * alignment.T_odom_sensor;
  twist_ = {motion.translation_m / dt_s, so3_log(motion.rotation) / dt_s};
  T_odom_sensor_ = alignment.T_odom_sensor;
}

void PaperOdometry::update_maps(const Reduced& scan) {
  const Pose since = T_odom_keyframe_.inverse() * T_odom_sensor_;
  const bool near = since.translation_m.norm() < config_.paper.keyframe_m &&
                    so3_log(since.rotation).norm() < config_.paper.keyframe_rad;
  if (motion_known() && near) return;
  T_odom_keyframe_ = T_odom_sensor_;
  edge_map_.update({scan.edges.get()}, T_odom_sensor_);
  surface_map_.update({scan.surfaces.get()}, T_odom_sensor_);
}

Estimate PaperOdometry::estimate(const Scan& scan, const Alignment& alignment) const {
  Estimate e;
  e.scan_index = scan.index;
  e.stamp_ns = scan.end_ns;
  e.T_odom_sensor = T_odom_sensor_;
  e.twist = twist_;
  e.status = scan_count_ == 1            ? TrackingStatus::initializing
             : alignment.converged       ? TrackingStatus::tracking
             : alignment.iterations == 0 ? TrackingStatus::lost
                                         : TrackingStatus::degraded;
  e.map_edge_count = static_cast<int>(edge_map_.cloud().size());
  e.map_surface_count = static_cast<int>(surface_map_.cloud().size());
  e.correspondence_count = alignment.correspondences;
  e.iterations = alignment.iterations;
  e.residual_rms_m = alignment.residual_rms_m;
  return e;
}

}  // namespace lilo::paper
