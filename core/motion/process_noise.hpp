// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/motion/motion_prior.hpp"

namespace lilo::core {

/// The process noise of the motion, estimated on the way: power densities of the acceleration's
/// white noise, adapted to the measured motion (Mehra, On the identification of variances and
/// adaptive Kalman filtering, 1970; Barfoot, State Estimation for Robotics, ch. 11).
///
/// Under white noise of density q on acceleration, the mean velocities over two adjacent intervals
/// of length T differ by a variance of 2/3 q T. The intervals run from the middle of one scan to
/// the middle of the next, because returns from all around hold the middle. Returns of one side
/// hold the end of a scan, and the same errors mislead the beginning of the next scan, which looks
/// the same way. So the motion within a scan gets as much freedom as the motion from scan to scan
/// shows, times a factor (motion::kFasterRotation), since shaking that is faster than the scans
/// cancels in part: little on a smooth road, much on a shaking mast. What one change of the
/// velocity shows of the translation is limited (motion::kMostTranslation): an alignment that
/// slipped would give the next ones the freedom to slip farther.
///
/// Not thread-safe; no allocation.
class ProcessNoise {
 public:
  /// `nominal`: density of each axis, rotation (rad^2/s^3), then translation (m^2/s^3). density()
  /// begins there and never falls below.
  explicit ProcessNoise(const Vector6d& nominal) : nominal_(nominal), density_(nominal) {}

  /// The pose in the middle of an aligned scan, and its instant. `variance`: of that pose by the
  /// scan's returns alone (rad^2, m^2). It is subtracted, since it makes velocities differ as well.
  /// If it is not finite the estimate stays.
  void observe(const Pose& T_middle, std::int64_t stamp_ns, const Vector6d& variance);
  /// The next pose does not continue the motion observed so far.
  void interrupt() { observed_ = 0; }
  /// A map is begun. What is observed next tells of its first scan.
  void begin_map() {
    interrupt();
    at_start_.setZero();
    changes_at_start_ = 0;
  }

  [[nodiscard]] const Vector6d& density() const { return density_; }
  /// For the pose that is reported. The nominal density leaves room for the motion to come, and
  /// most vehicles turn far more smoothly. No scan begins with the reported pose. So its rotation
  /// gets the density that was observed, motion::kReportedLeast of the nominal one at least, and a
  /// further factor for what shakes faster than the scans: at the end of a scan nothing of it
  /// cancels (motion::kReportedRotation). As density() before anything was observed.
  [[nodiscard]] Vector6d reported_density() const;
  /// The mean of what was observed of the first motion::kStartChanges changes of the motion since
  /// the map was begun: with no least value, no limit, and without the factor for what is faster
  /// than the scans. Zero before the first.
  [[nodiscard]] const Vector6d& density_at_start() const { return at_start_; }

 private:
  void learn(const Vector6d& density);

  Vector6d nominal_, density_;
  // The rotation's part of density_, but with no least value; and the changes of the motion in it.
  Eigen::Vector3d rotation_density_ = Eigen::Vector3d::Zero();
  std::int64_t changes_ = 0;
  Vector6d at_start_ = Vector6d::Zero();
  int changes_at_start_ = 0;  // of which at_start_ is the mean
  int observed_ = 0;          // poses on end, up to two
  Pose T_middle_;
  std::int64_t stamp_ns_ = 0;
  Vector6d velocity_ = Vector6d::Zero();  // over the last interval: rotation, translation
  double interval_s_ = 0.0;
};

}  // namespace lilo::core
