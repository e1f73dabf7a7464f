// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/calibration/beam_estimate.hpp"
#include "core/estimate.hpp"
#include "core/feature_extractor.hpp"
#include "core/odometry_config.hpp"
#include "core/scan.hpp"
#include "core/stage.hpp"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace lilo {

/// Whether this program has the profile: `paper` needs OpenCV and PCL, and lilod is without.
bool has_profile(Profile profile);

/// LiDAR odometry: scans in, poses out. Same scans, same bits out.
/// Not thread-safe: one thread calls.
class Odometry {
 public:
  /// Throws std::invalid_argument when the program lacks the profile.
  explicit Odometry(const OdometryConfig& config);
  ~Odometry();
  Odometry(const Odometry&) = delete;
  Odometry& operator=(const Odometry&) = delete;

  /// Takes the next scan and says where the sensor was at its last firing. Never throws on data:
  /// a scan too poor to align gives the prediction with status `lost`.
  Estimate process(const Scan& scan, StageHook hook = {});

  /// The same in parts, so that the pose comes early: align() and then update_map(), both with the
  /// features that FeatureExtractor found in the scan. All of them must come from one extractor, so
  /// that their axes stay the same (ScanFeatures::R_level_sensor). align() corrects them in place
  /// by the estimated errors of the sensor's beams. Profile paper does all of it in align().
  Estimate align(const Scan& scan, ScanFeatures& features, StageHook hook = {});
  /// Adds the scan just aligned to the map. To be called once after each align().
  void update_map(const ScanFeatures& features, StageHook hook = {});

  /// Before the first scan: begins with what an earlier run found of the sensor's beams. It is
  /// dropped where the sensor has another number of rings, where calibrate_beams is off, and by
  /// profile paper.
  void resume_beams(const BeamEstimate& kept);
  /// What has been found of the beams so far; nothing (no rings) without calibrate_beams and by
  /// profile paper.
  [[nodiscard]] BeamEstimate beam_estimate() const;

  /// Angle (rad) by which the last scan was levelled (ScanFeatures::R_level_sensor). 0: it was not
  /// (core::Levelling says when), there was none yet, or the profile is paper.
  [[nodiscard]] double tilt_rad() const;

  /// The local map in the odometry frame (m), in no particular order: profile default, the mean of
  /// every fine cell; paper, both map clouds. Allocates: for saving, not for every scan.
  [[nodiscard]] std::vector<Eigen::Vector3f> map_points() const;

  /// The features by which the last scan was aligned, in the sensor's frame at the instant of its
  /// pose (m): at most `most` points, evenly from all of them. `out` is overwritten; it allocates
  /// if its capacity is less. Profile paper: none.
  void aligned_points(std::size_t most, std::vector<Eigen::Vector3f>& out) const;
  /// The points that the last update_map() added to the map, likewise; none if it did not grow.
  void mapped_points(std::size_t most, std::vector<Eigen::Vector3f>& out) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lilo
