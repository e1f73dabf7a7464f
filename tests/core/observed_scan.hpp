// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/image/feature_image.hpp"
#include "core/tracking/observation.hpp"
#include "tests/core/analytic_scene.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace lilo::test {

/// What the parts of the tracker take of a scan. All of its features are selected.
class ObservedScan {
 public:
  ObservedScan(const Scene& scene, const std::function<Pose(double)>& T_world_sensor,
               std::uint64_t index, int firings = 900) {
    const Scan scan = scan_of(scene, even_beams(16, -15.0, 15.0), firings, T_world_sensor, index);
    features_ = core::FeatureImage(1024, {}).build(scan);
    observation_ = core::observe(scan, features_);
  }
  ObservedScan(const ObservedScan&) = delete;
  ObservedScan& operator=(const ObservedScan&) = delete;

  [[nodiscard]] const std::vector<Feature>& features() const { return features_; }
  [[nodiscard]] const core::Observation& observation() const { return observation_; }
  [[nodiscard]] const core::ScanTiming& timing() const { return observation_.timing; }

 private:
  std::vector<Feature> features_;
  core::Observation observation_;
};

/// At constant speed along x, with the first firing of scan 0 at `from_x_m`.
inline std::function<Pose(double)> along_x(double speed_mps, std::uint64_t index,
                                           double from_x_m = 0.0) {
  return [=](double s) {
    const double t_s = 0.1 * (static_cast<double>(index) + s);
    return Pose{Eigen::Quaterniond::Identity(), {from_x_m + speed_mps * t_s, 0.0, 0.0}};
  };
}

}  // namespace lilo::test
