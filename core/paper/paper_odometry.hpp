// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/estimate.hpp"
#include "core/feature.hpp"
#include "core/odometry_config.hpp"
#include "core/paper/local_map.hpp"
#include "core/paper/registration.hpp"
#include "core/scan.hpp"
#include "core/stage.hpp"

namespace lilo::paper {

/// Edges and surfaces (with ground or without, by group), one point a voxel.
struct Reduced {
  Cloud::Ptr edges{new Cloud};
  Cloud::Ptr surfaces{new Cloud};
};

/// The LiLO paper's odometry, Figure 1, with PCL's kd-trees and voxel grids. Allocates as PCL does.
class PaperOdometry {
 public:
  /// Sets OpenCV to one thread, for the whole program: its pool would inherit the core and the
  /// scheduling policy of the thread that calls, and fight it for both.
  explicit PaperOdometry(const OdometryConfig& config);
  Estimate process(const Scan& scan, StageHook hook);
  /// The same calls as profile default. The method finds its own features, and its map grows before
  /// the pose is returned.
  Estimate align(const Scan& scan, const BeamTable& /*beams*/,
                 const std::vector<Feature>& /*features*/, StageHook hook) {
    return process(scan, hook);
  }
  void update_map(const std::vector<Feature>& /*features*/, StageHook /*hook*/) {}
  [[nodiscard]] std::vector<Eigen::Vector3f> map_points() const;

 private:
  [[nodiscard]] Reduced reduce(const Features& features) const;
  [[nodiscard]] Alignment align_to_map(const Reduced& scan, double dt_s) const;
  void advance(const Alignment& alignment, double dt_s);
  /// False for the first scans, whose prediction knows nothing of a start in motion.
  [[nodiscard]] bool motion_known() const { return scan_count_ >= 3; }
  /// Adds the scan to both maps when the sensor has moved or turned far enough since the last time
  /// (keyframe_m, keyframe_rad): the paper cleans its maps "as the robot translation increases" and
  /// is silent on how often they grow.
  void update_maps(const Reduced& scan);
  [[nodiscard]] Estimate estimate(const Scan& scan, const Alignment& alignment) const;

  OdometryConfig config_;
  LocalMap edge_map_, surface_map_;
  Pose T_odom_sensor_;
  Pose T_odom_keyframe_;  // where the maps last grew
  Twist twist_;           // of the sensor over the last interval
  std::int64_t last_end_ns_ = 0;
  int scan_count_ = 0;
};

}  // namespace lilo::paper
