// SPDX-License-Identifier: BSD-3-Clause
#include "core/motion/process_noise.hpp"

#include "core/constants.hpp"

#include <algorithm>

namespace lilo::core {

void ProcessNoise::observe(const Pose& T_middle, std::int64_t stamp_ns, const Vector6d& variance) {
  const double interval_s = 1e-9 * static_cast<double>(stamp_ns - stamp_ns_);
  const Pose from = T_middle_;
  T_middle_ = T_middle;
  stamp_ns_ = stamp_ns;
  if (observed_ == 0 || interval_s < motion::kLeastInterval_s || interval_s > motion::kShortGap_s) {
    observed_ = 1;
    return;
  }
  Vector6d velocity;
  velocity << so3_log((T_middle.rotation * from.rotation.conjugate()).normalized()),
      T_middle.translation_m - from.translation_m;
  velocity /= interval_s;
  if (observed_ == 2) {
    // Three poses are in it, the middle one twice.
    const Vector6d of_poses = 6.0 * variance / (interval_s * interval_s);
    const Vector6d square = ((velocity - velocity_).cwiseAbs2() - of_poses).cwiseMax(0.0);
    const Vector6d density = square * (1.5 * 2.0 / (interval_s + interval_s_));
    const Vector6d shared = mean_by_kind(density);
    // Information that is nearly singular may come out with a negative variance.
    if (shared.allFinite() && variance.minCoeff() >= 0.0) learn(shared);
  }
  observed_ = 2;
  velocity_ = velocity;
  interval_s_ = interval_s;
}

void ProcessNoise::learn(const Vector6d& density) {
  if (changes_at_start_ < motion::kStartChanges) {
    ++changes_at_start_;
    at_start_ += (density - at_start_) / changes_at_start_;
  }
  Vector6d newest = density;
  newest.head<3>() *= motion::kFasterRotation;
  newest.tail<3>() *= motion::kFasterTranslation;
  // By chance hardly any change is so large.
  newest.tail<3>() = newest.tail<3>().cwiseMin(motion::kMostTranslation * density_.tail<3>());
  density_ += motion::kNoiseSmoothing * (newest - density_);
  density_ = density_.cwiseMax(nominal_);
  ++changes_;
  const double weight = std::max(motion::kNoiseSmoothing, 1.0 / static_cast<double>(changes_));
  rotation_density_ += weight * (newest.head<3>() - rotation_density_);
}

Vector6d ProcessNoise::reported_density() const {
  if (changes_ == 0) return density_;
  const Eigen::Vector3d least = motion::kReportedLeast * nominal_.head<3>();
  Vector6d density = density_;
  density.head<3>() = (motion::kReportedRotation * rotation_density_).cwiseMax(least);
  return density;
}

}  // namespace lilo::core
