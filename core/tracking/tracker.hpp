#pragma once

#include "core/estimate.hpp"
#include "core/image/selection.hpp"
#include "core/motion/process_noise.hpp"
#include "core/motion/standing.hpp"
#include "core/odometry_config.hpp"
#include "core/registration/solver.hpp"
#include "core/registration/weak_directions.hpp"
#include "core/scan.hpp"
#include "core/search/footprint.hpp"
#include "core/search/relocalizer.hpp"
#include "core/stage.hpp"
#include "core/tracking/drift.hpp"
#include "core/tracking/motion_check.hpp"

#include <array>
#include <utility>
#include <vector>

namespace lilo::core {

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
  static constexpr std::size_t kScansToDecide = 6;
  static constexpr int kYoung = 5;              // keyframes of a map that may know too little
  static constexpr int kGrown = 15;             // keyframes of a map that must know where it is
  static constexpr double kUnseen_s = 0.35;     // for so long a prediction is good to half a cell
  static constexpr double kDoubtful = 0.55;     // of what fits usually: a better one may be missed
  static constexpr double kNothing = 0.25;      // chance alone
  static constexpr double kSearchable_s = 2.5;  // later it may be farther than Relocalizer looks
  struct Timing {
    std::int64_t start_ns = 0, end_ns = 0;
    bool motion_compensated = false;
  };
  /// What the first scans leave behind until the motion is known.
  struct Seen {
    Timing timing;
    Pose T_begin, T_end;  ///< as tracked; of the newest as predicted
    std::size_t feature_count = 0;
    std::vector<Feature> for_map, chosen;
    Outline outline;  ///< of the chosen
    Plan plan;        ///< of the outline, under the turn last looked at
  };
  /// What a scan brings to the map, kept until the next one has told where it ended.
  struct Held {
    std::vector<Feature> features;
    Trajectory trajectory;
    std::int64_t end_ns = 0;
    bool waiting = false;
  };
  /// A motion the sensor may have had when it was switched on.
  struct Start {
    Twist twist;  ///< as found so far
    Eigen::Vector3d believed_mps = Eigen::Vector3d::Zero();
    double doubt_mps = 0.0;  ///< 1 sigma of it, along the ground
    bool moves = false;
    bool is_clear = false;  ///< no other motion fits the scans nearly as well
  };

  /// A constant motion, and the cells that what was seen takes up under it.
  struct Look {
    Twist twist;
    int cells = 0;
  };

  static KnotInformation first_information();
  static double span_of(const Timing& timing);
  static bool follows(const Timing& scan, std::int64_t end_ns);
  [[nodiscard]] Prior predict(const Timing& scan) const;
  Solution solve(const Scan& scan, const std::vector<Feature>& chosen, const Prior& prior);
  Solution align_moving_or_standing(const std::vector<Feature>& chosen, const Prior& prior);
  void observe_motion();
  void accept(const Timing& scan, const Prior& prior, const Solution& solution);
  bool is_refuted(const std::vector<Feature>& chosen);
  void find_weak_directions();
  [[nodiscard]] TrackingStatus status_of(const Scan& scan, const Solution& solution,
                                         const std::vector<Feature>& chosen) const;
  [[nodiscard]] Estimate estimate(const Scan& scan, const Solution& solution,
                                  const std::vector<Feature>& chosen) const;
  [[nodiscard]] Matrix6d alignment_covariance() const;
  [[nodiscard]] Matrix6d sensor_covariance() const;

  // The way back into the map, in tracker_relocalization.cpp.
  [[nodiscard]] double relative_fit(const Solution& solution,
                                    const std::vector<Feature>& chosen) const;
  void learn_fit(const std::vector<Feature>& chosen);
  [[nodiscard]] bool is_explained(const Solution& solution,
                                  const std::vector<Feature>& chosen) const;
  Solution follow_turn(const Solution& found, const std::vector<Feature>& chosen,
                       const Prior& prior);
  Solution solve_turned(const Displacement& by, const std::vector<Feature>& chosen, Prior prior);
  void draw_map(const Eigen::Vector3d& center_m);
  [[nodiscard]] bool is_unsearchable() const;
  [[nodiscard]] bool stood() const;
  bool is_gone(const std::vector<Feature>& chosen);
  [[nodiscard]] bool is_in_place(const Solution& found, const Prior& prior,
                                 const std::vector<Feature>& chosen) const;
  [[nodiscard]] double unseen_s() const;
  [[nodiscard]] bool may_be_elsewhere() const;
  Solution relocalize(const Scan& scan, const std::vector<Feature>& chosen, const Prior& prior);
  void attempt_everywhere(const std::vector<Feature>& chosen, const Prior& prior);
  Solution solve_from(const Pose& T_end, const std::vector<Feature>& chosen, Prior prior);
  [[nodiscard]] bool stands_out(const Solution& best) const;

  // The map, in tracker_map.cpp.
  void grow_map(const Timing& scan, const std::vector<Feature>& features, const Solution& solution);
  [[nodiscard]] bool is_young(const Solution& solution) const;
  /// How many features a keyframe may add to the map.
  [[nodiscard]] std::size_t for_map() const {
    return static_cast<std::size_t>(config_.default_profile.map_features);
  }
  void hold(const std::vector<Feature>& features, const Trajectory& trajectory,
            std::int64_t end_ns);
  void insert_held();

  // The start, in tracker_start.cpp.
  void start_anew();
  void stand_at_origin();
  void rewind();
  Solution try_start(const Start& start);
  static void believe(const Start& start, Prior& prior);
  Solution refine(Start& start);
  Solution start();
  static bool is_elsewhere(const Twist& twist, const Twist& tracked);
  [[nodiscard]] Twist twist_so_far() const;
  Start best_start(const Twist& tracked);
  void rehearse(Start start);
  void decide();
  void doubt_standing();
  static void note_track(Seen& seen, const Pose& T_begin, const Pose& T_end);
  void note_prediction(Seen& seen) const;
  [[nodiscard]] bool is_start_vain(std::size_t feature_count) const;
  void remember(const std::vector<Feature>& all, const std::vector<Feature>& chosen);

  // The search for the motion at the start, in tracker_search.cpp.
  static bool differ(const Twist& a, const Twist& b, double mps, double radps);
  [[nodiscard]] int cells_as_tracked();
  [[nodiscard]] std::pair<double, double> since_first(const Timing& timing) const;
  void turn(const Eigen::Vector3d& angular_radps, Share share);
  Look look_turned(const Twist& twist, Share share);
  Look look(const Twist& twist, Share share = Share::all);
  Look look_around(const Twist& about, Share share);
  [[nodiscard]] int cells_alone(Share share);
  /// Whether what was seen speaks for the motion with `cells` and against the other.
  static bool speaks_for(int cells_alone, int cells, int other_cells, double sigmas);
  void look_everywhere();
  void look_closer();
  [[nodiscard]] Look least_look() const;
  Start most_compact();

  OdometryConfig config_;
  Selection selection_;
  LocalMaps maps_;
  Solver solver_;
  Timing timing_;      // of the last scan
  Solution solution_;  // of the last scan
  Sampled sampled_;
  Held held_;
  std::vector<LocalMaps::Point> points_;    // of the features that enter the map
  std::size_t finest_ = LocalMaps::kUsual;  // level of the maps for these surroundings
  Drift drift_;
  WeakDirections weak_;  // of the last scan
  ProcessNoise process_noise_;
  Standing standing_;
  Footprint footprint_;
  MotionCheck motion_check_;
  Relocalizer relocalizer_;
  std::array<Solution, Relocalizer::kMostPlaces + 1> attempts_;  // to find the place again
  std::size_t attempt_count_ = 0;

  Pose T_odom_start_;  // where the map in force was begun; all other poses here are from there
  Pose T_odom_sensor_;
  int lost_scans_ = 0;
  std::uint32_t restarts_ = 0;
  int keyframes_ = 0;       // in the map in force
  Vector6d design_effect_;  // mean of the last second
  Twist twist_;
  KnotInformation information_;  // of the pose and its rate at the last scan's end
  Pose T_odom_keyframe_;
  std::int64_t last_end_ns_ = 0;
  std::int64_t last_aligned_ns_ = 0;  // end of the last scan that was not lost
  std::int64_t drawn_at_ns_ = 0;      // the same, when the relocalizer was given the map
  double usual_fit_ = 0.0;  // the part of structure that fits the map, of late; 0: not known
  // The last scan: fitted much less than usual; may be right even so.
  bool is_doubtful_ = false, is_explained_ = true;
  int scan_count_ = 0;
  TrackingStatus status_ = TrackingStatus::initializing;
  std::array<Seen, kScansToDecide> seen_;  // the first scans, until the motion is known
  std::size_t seen_count_ = 0;
  bool start_is_clear_ = false;
  bool stands_ = false;  // when switched on, or so it seemed
  Twist assumed_twist_;  // at the start
  std::vector<Look> looks_;
};

}  // namespace lilo::core
