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
  Estimate align(const Scan& scan, const std::vector<Feature>& features, StageHook hook);
  /// Once after each align(), with the same features.
  void update_map(const std::vector<Feature>& features, StageHook hook);
  [[nodiscard]] std::vector<Eigen::Vector3f> map_points() const;

 private:
  static constexpr int kYoung = 5;  // keyframes of a map that may know too little
  struct Timing {
    std::int64_t start_ns = 0, end_ns = 0;
    bool motion_compensated = false;
  };
  /// What the first scans leave behind until the motion is known.
  struct Seen {
    Timing timing;
    std::vector<Feature> all, chosen;
  };
  /// A motion the sensor may have had when it was switched on.
  struct Start {
    Twist twist;  ///< as found so far
    Eigen::Vector3d believed_mps = Eigen::Vector3d::Zero();
    double doubt_mps = 0.0;  ///< 1 sigma of it, along the ground
    double inliers = 0.0;    ///< features it explains
    double structure = 0.0;  ///< of them what is not ground
    double misfit = 0.0;     ///< mean square of what it leaves, in sigmas
  };

  static KnotInformation first_information();
  static double span_of(const Timing& timing);
  [[nodiscard]] Prior predict(const Timing& scan) const;
  void accept(const Timing& scan, const Prior& prior, const Solution& solution);
  void grow_map(const std::vector<Feature>& features, const Solution& solution);
  void insert(const std::vector<Feature>& features, const Trajectory& trajectory);

  // The start, in tracker_start.cpp.
  void start_anew();
  void stand_at_origin();
  void rewind();
  Solution try_start(Start& start);
  Solution refine(Start& start, int rounds);
  Solution start();
  std::vector<Start> rivals(std::vector<Start> tried);
  void rehearse(Start& start, bool fill_map);
  void decide();
  void remember(const Timing& timing, const std::vector<Feature>& all,
                const std::vector<Feature>& chosen);
  [[nodiscard]] TrackingStatus status_of(const Scan& scan, const Solution& solution,
                                         std::size_t feature_count) const;
  [[nodiscard]] Estimate estimate(const Scan& scan, const Solution& solution,
                                  const std::vector<Feature>& chosen) const;

  OdometryConfig config_;
  Selection selection_;
  LocalMaps maps_;
  Solver solver_;
  Solution solution_;  // of the last scan
  Sampled sampled_;

  Pose T_odom_start_;  // where the map in force was begun; all other poses here are from there
  Pose T_odom_sensor_;
  int lost_scans_ = 0;
  int keyframes_ = 0;  // in the map in force
  Twist twist_;
  KnotInformation information_;  // of the pose and its rate at the last scan's end
  Pose T_odom_keyframe_;
  std::int64_t last_end_ns_ = 0;
  int scan_count_ = 0;
  TrackingStatus status_ = TrackingStatus::initializing;
  std::vector<Seen> seen_;     // the first scans, until the motion is known
  std::vector<Start> starts_;  // where several fit them: the one in force first
};

}  // namespace lilo::standard
