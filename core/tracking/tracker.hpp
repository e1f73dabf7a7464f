// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/calibration/beam_calibration.hpp"
#include "core/estimate.hpp"
#include "core/image/selection.hpp"
#include "core/odometry_config.hpp"
#include "core/registration/weak_directions.hpp"
#include "core/scan.hpp"
#include "core/search/motion_check.hpp"
#include "core/stage.hpp"
#include "core/tracking/confirmation.hpp"
#include "core/tracking/initializer.hpp"
#include "core/tracking/local_odometry.hpp"
#include "core/tracking/observation.hpp"
#include "core/tracking/relocalizer.hpp"
#include "core/tracking/tall_structure.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace lilo::core {

/// What the tracker is doing:
///
///     starting -> tracking   the initial motion is known (Initializer: 4 or 6 scans)
///     starting -> lost       it is known, but no scan was aligned for 0.35 s (motion::kShortGap_s)
///     tracking -> lost       no scan was aligned for 0.35 s
///     lost     -> tracking   the sensor was found in the map (Relocalizer)
///
/// A new session begins with an empty map and the phase `starting`, from
///
///     starting   the first scans cannot be continued: a fragment, or too long ago
///     any        ten scans, each with enough features, were not explained by the map
///     tracking   another motion explains the last scans better; or two motions fitted for ten
///                scans, and no longer do (MotionCheck)
///     lost       no scan was aligned for 2.5 s (motion::kLongestGap_s), unless the sensor was
///                stationary or is exactly where it was predicted
enum class Phase : std::uint8_t { starting, tracking, lost };

/// The default odometry: features of the image plane, their exact returns and firing times, aligned
/// with a local map of Gaussian cells by a smooth trajectory through the scan.
///
/// "The sensor's frame" here, and in all classes that the tracker uses, has the axes of the
/// features (ScanFeatures::R_level_sensor). Odometry turns the results to the sensor's own axes.
///
/// Not thread-safe; no allocation after the first scans.
class Tracker {
 public:
  explicit Tracker(const OdometryConfig& config);
  /// `beams`: by the rings of the features. Corrects the features in place by what is known of
  /// them.
  Estimate align(const Scan& scan, const BeamTable& beams, std::vector<Feature>& features,
                 StageHook hook);
  /// Once after each align(), with the same features.
  void update_map(const std::vector<Feature>& features, StageHook hook);
  [[nodiscard]] std::vector<Eigen::Vector3f> map_points() const;
  /// As in Odometry, but for the axes.
  void aligned_points(std::size_t most, std::vector<Eigen::Vector3f>& out) const;
  void mapped_points(std::size_t most, std::vector<Eigen::Vector3f>& out) const;
  [[nodiscard]] Phase phase() const { return phase_; }
  /// As in Odometry.
  void resume_beams(const BeamEstimate& kept);
  [[nodiscard]] BeamEstimate beam_estimate() const {
    return calibrates_ ? calibration_.estimate() : BeamEstimate{};
  }

 private:
  /// The result of one scan.
  struct Alignment {
    Solution solution;
    TrackingStatus status = TrackingStatus::initializing;  ///< before weak directions are known
    bool is_explained = true;                              ///< it may be right (is_explained())
    bool is_good = false;                                  ///< it converged, and fits as usual
    bool is_refuted = false;                               ///< another motion fits better
    WeakDirections weak;
  };
  /// One map and the place where it was begun.
  struct Session {
    Pose T_odom_start;
    std::uint32_t restarts = 0;
    /// A sensor that was just switched on is mostly stationary. After a map was given up, more
    /// scans must tell.
    bool may_be_stationary = true;
    bool is_over = false;       ///< the next scan begins another one
    int unexplained_scans = 0;  ///< in a row, with enough features
  };
  void begin_session(bool may_be_stationary);
  /// Whether the scan judged last was not found in the map, or its motion was refuted.
  [[nodiscard]] bool is_lost() const { return alignment_.status == TrackingStatus::lost; }
  [[nodiscard]] bool is_first() const { return initializer_.scans() == 1; }
  Prior begin_scan(const std::vector<Feature>& features);
  Solution align_from_prediction(const Prior& prior);
  std::optional<Solution> solve(const Prior& predicted);
  std::optional<Solution> relocalize(const Solution& at_prediction, const Prior& prior);
  [[nodiscard]] Alignment judge(const Solution& solution) const;
  void accept(const Prior& prior);
  [[nodiscard]] bool is_checked() const;
  [[nodiscard]] bool check_motion();
  void watch_session();
  void calibrate();
  void confirm();
  [[nodiscard]] Estimate estimate(const Scan& scan) const;

  Selection selection_;
  LocalOdometry local_;
  Initializer initializer_;
  Relocalizer relocalizer_;
  MotionCheck motion_check_;
  BeamCalibration calibration_;
  Session session_;
  Confirmation confirmation_;
  TallStructure tall_structure_;
  Phase phase_ = Phase::starting;
  bool calibrates_;
  BeamTable beams_;      // of the last scan
  Observation scan_;     // the last scan
  Alignment alignment_;  // of it
  AlignmentHistory history_;
  StructureFit start_fit_;  // of the last scan of phase `starting`: the usual fit after it
};

}  // namespace lilo::core
