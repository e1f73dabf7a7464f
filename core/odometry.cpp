// SPDX-License-Identifier: BSD-3-Clause
#include "core/odometry.hpp"

#include "core/level_frame.hpp"
#ifdef LILO_PAPER
#include "core/paper/paper_odometry.hpp"
#endif
#include "core/tracking/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <variant>

namespace lilo {

#ifdef LILO_PAPER
using AnyProfile = std::variant<core::Tracker, paper::PaperOdometry>;
#else
using AnyProfile = std::variant<core::Tracker>;
#endif

struct Odometry::Impl {
  AnyProfile profile;
  FeatureExtractor extractor;
  ScanFeatures features;
  Eigen::Quaterniond R_level_sensor = Eigen::Quaterniond::Identity();  // of the last scan
  std::optional<BeamEstimate> kept_beams;  // until the first scan with features tells the axes
  const bool estimates_beams = false;

  /// Of a level sensor nothing is turned: its poses keep their bits.
  [[nodiscard]] bool is_levelled() const { return R_level_sensor.w() != 1.0; }
  void resume_kept_beams() {
    if (!kept_beams) return;
    std::get<core::Tracker>(profile).resume_beams(in_level_axes(*kept_beams, R_level_sensor));
    kept_beams.reset();
  }
};

namespace {

AnyProfile make_profile(const OdometryConfig& config) {
  if (config.profile == Profile::default_profile) return core::Tracker(config);
#ifdef LILO_PAPER
  return paper::PaperOdometry(config);
#else
  throw std::invalid_argument("odometry.profile: this program has no profile paper");
#endif
}

}  // namespace

bool has_profile(Profile profile) {
#ifdef LILO_PAPER
  return profile == Profile::default_profile || profile == Profile::paper;
#else
  return profile == Profile::default_profile;
#endif
}

Odometry::Odometry(const OdometryConfig& config)
    : impl_(new Impl{.profile = make_profile(config),
                     .extractor = FeatureExtractor(config),
                     .estimates_beams = estimates_beams(config)}) {}

Odometry::~Odometry() = default;

Estimate Odometry::process(const Scan& scan, StageHook hook) {
  impl_->extractor.finish(scan, impl_->features);
  if (std::holds_alternative<core::Tracker>(impl_->profile)) hook(Stage::project);
  Estimate estimate = align(scan, impl_->features, hook);
  update_map(impl_->features, hook);
  return estimate;
}

Estimate Odometry::align(const Scan& scan, ScanFeatures& features, StageHook hook) {
  impl_->R_level_sensor = features.R_level_sensor;
  if (!features.all.empty()) impl_->resume_kept_beams();  // its axes are those of all from it on
  const BeamTable beams = in_level_axes(scan.beams, features.R_level_sensor);
  const Estimate estimate =
      std::visit([&](auto& profile) { return profile.align(scan, beams, features.all, hook); },
                 impl_->profile);
  return impl_->is_levelled() ? in_sensor_axes(estimate, impl_->R_level_sensor) : estimate;
}

void Odometry::update_map(const ScanFeatures& features, StageHook hook) {
  std::visit([&](auto& profile) { profile.update_map(features.all, hook); }, impl_->profile);
}

void Odometry::resume_beams(const BeamEstimate& kept) {
  if (impl_->estimates_beams && kept.ring_count > 0) impl_->kept_beams = kept;
}

BeamEstimate Odometry::beam_estimate() const {
  if (impl_->kept_beams) return *impl_->kept_beams;
  const auto* tracker = std::get_if<core::Tracker>(&impl_->profile);
  if (tracker == nullptr) return {};
  return in_sensor_axes(tracker->beam_estimate(), impl_->R_level_sensor);
}

double Odometry::tilt_rad() const {
  const Eigen::Vector3d z = impl_->R_level_sensor * Eigen::Vector3d::UnitZ();
  return impl_->is_levelled() ? std::acos(std::clamp(z.z(), -1.0, 1.0)) : 0.0;
}

std::vector<Eigen::Vector3f> Odometry::map_points() const {
  std::vector<Eigen::Vector3f> points_m =
      std::visit([](const auto& profile) { return profile.map_points(); }, impl_->profile);
  if (impl_->is_levelled()) turn_to_sensor_axes(impl_->R_level_sensor, points_m);
  return points_m;
}

void Odometry::aligned_points(std::size_t most, std::vector<Eigen::Vector3f>& out) const {
  out.clear();
  const auto* tracker = std::get_if<core::Tracker>(&impl_->profile);
  if (tracker == nullptr) return;
  tracker->aligned_points(most, out);
  if (impl_->is_levelled()) turn_to_sensor_axes(impl_->R_level_sensor, out);
}

void Odometry::mapped_points(std::size_t most, std::vector<Eigen::Vector3f>& out) const {
  out.clear();
  const auto* tracker = std::get_if<core::Tracker>(&impl_->profile);
  if (tracker == nullptr) return;
  tracker->mapped_points(most, out);
  if (impl_->is_levelled()) turn_to_sensor_axes(impl_->R_level_sensor, out);
}

}  // namespace lilo
