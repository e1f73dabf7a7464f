#pragma once

#include "core/odometry.hpp"
#include "core/standard/selection.hpp"
#include "core/standard/solver.hpp"

#include <vector>

namespace lilo::standard {

/// The default odometry: features of the image plane, their exact returns and firing times, aligned
/// with a local map of Gaussian cells by a smooth trajectory through the scan.
class Tracker {
 public:
  explicit Tracker(const OdometryConfig& config);
  Estimate process(const Scan& scan, StageHook hook);
  [[nodiscard]] std::vector<Eigen::Vector3f> map_points() const;

 private:
  [[nodiscard]] Prior predict(const Scan& scan) const;
  Solution try_start(const std::vector<Feature>& chosen, Prior prior, const Twist& twist,
                     double doubt_mps);
  Solution start(const std::vector<Feature>& chosen, const Prior& prior);
  void accept(const Scan& scan, const Prior& prior, const Solution& solution);
  void grow_map(const std::vector<Feature>& features, const Trajectory& trajectory);
  void insert(const std::vector<Feature>& features, const Trajectory& trajectory);
  [[nodiscard]] TrackingStatus status_of(const Scan& scan, const Solution& solution,
                                         std::size_t feature_count) const;
  [[nodiscard]] Estimate estimate(const Scan& scan, const Solution& solution,
                                  const std::vector<Feature>& chosen) const;

  OdometryConfig config_;
  FeatureImage image_;
  Selection selection_;
  LocalMaps maps_;
  Solver solver_;
  Sampled sampled_;

  Pose T_odom_sensor_;
  Twist twist_;
  KnotInformation information_;  // of the pose and its rate at the last scan's end
  Pose T_odom_keyframe_;
  std::int64_t last_end_ns_ = 0;
  int scan_count_ = 0;
  TrackingStatus status_ = TrackingStatus::initializing;
  std::vector<Feature> first_features_;  // of the first scan, until its motion is known
  double first_span_s_ = 0.0;
};

}  // namespace lilo::standard
