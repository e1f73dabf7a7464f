#include "core/tracking/tracker.hpp"

#include "core/registration/weak_directions.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lilo::core {
namespace {

constexpr std::size_t kMinFeatures = 100;
constexpr std::size_t kMostLooks = 4096;
constexpr double kNewest = 0.1;  // weight of a scan in running means
// A simulation without noise is no reason to be sure.
constexpr double kLeastDesignEffect = 0.05;
constexpr int kScansToGiveUp = 10;  // that saw enough and found nothing of it in the map

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

CellMapConfig map_config(const DefaultConfig& config, FeatureKind kind, double cell_m,
                         int capacity) {
  return {.cell_m = static_cast<float>(cell_m),
          .noise_m = static_cast<float>(config.noise_m),
          .level = kind == FeatureKind::ground,
          .capacity = capacity};
}

LocalMaps make_maps(const DefaultConfig& c) {
  const auto level = [&](double cell_m, int capacity) {
    return std::array{map_config(c, FeatureKind::ground, cell_m, capacity),
                      map_config(c, FeatureKind::structure, cell_m, capacity)};
  };
  // Cells of a surface grow fewer with the square of their size; a quarter leaves room.
  return LocalMaps({level(0.5 * c.cell_m, c.map_cells / 4), level(c.cell_m, c.map_cells),
                    level(c.coarse_cell_m, c.map_cells / 4)});
}

SolverConfig solver_config(const DefaultConfig& c) {
  SolverConfig s;
  s.max_iterations = c.max_iterations;
  s.ground_kernel = static_cast<float>(c.ground_kernel);
  s.structure_kernel = static_cast<float>(c.structure_kernel);
  s.data_weight = static_cast<float>(c.data_weight);
  return s;
}

Vector6d nominal_density(const DefaultConfig& c) {
  Vector6d density;
  density << c.roll_pitch_density, c.roll_pitch_density, c.yaw_density,
      Eigen::Vector3d::Constant(c.translation_density);
  return density;
}

/// The level of the maps that these surroundings ask for: half cells where more than half of what
/// stands is near, as in rooms.
std::size_t finest_level(const std::vector<Feature>& chosen) {
  constexpr float kNarrow_m = 5.0F;
  int near = 0, all = 0;
  for (const Feature& f : chosen) {
    if (f.kind == FeatureKind::ground) continue;
    ++all;
    near += static_cast<int>(f.x_m * f.x_m + f.y_m * f.y_m + f.z_m * f.z_m < kNarrow_m * kNarrow_m);
  }
  return 2 * near > all ? LocalMaps::kNarrow : LocalMaps::kUsual;
}

}  // namespace

Tracker::Tracker(const OdometryConfig& config)
    : config_(config),
      selection_(config.default_profile.ground_features, config.default_profile.structure_features),
      maps_(make_maps(config.default_profile)),
      solver_(solver_config(config.default_profile), selection_.most()),
      process_noise_(nominal_density(config.default_profile)),
      footprint_(selection_.most()),
      motion_check_(selection_.most()),
      relocalizer_(selection_.most()),
      design_effect_(Vector6d::Constant(kLeastDesignEffect)),
      information_(first_information()) {
  held_.features.reserve(for_map());
  points_.reserve(for_map());
  looks_.reserve(kMostLooks);
  for (Seen& seen : seen_) {
    seen.for_map.reserve(for_map());
    seen.chosen.reserve(selection_.most());
    seen.outline.reserve(selection_.most());
    seen.plan.reserve(selection_.most());
  }
}

Estimate Tracker::align(const Scan& scan, const std::vector<Feature>& features, StageHook hook) {
  const std::vector<Feature>& chosen = selection_.choose(features);
  hook(Stage::filter);
  timing_ = {scan.start_ns, scan.end_ns, scan.motion_compensated};
  finest_ = finest_level(chosen);
  if (chosen.size() >= kMinFeatures && is_gone(chosen)) {
    start_anew();
    ++restarts_;
  }
  remember(features, chosen);
  const Prior prior = predict(timing_);
  solution_ = solve(scan, chosen, prior);
  status_ = status_of(scan, solution_, chosen);
  is_doubtful_ = relative_fit(solution_, chosen) < kDoubtful;
  is_explained_ = status_ != TrackingStatus::lost && is_explained(solution_, chosen);
  if (is_explained_) {
    last_aligned_ns_ = timing_.end_ns;
    learn_fit(chosen);
  }
  observe_motion();
  accept(timing_, prior, solution_);
  if (status_ != TrackingStatus::lost) standing_.observe(T_odom_sensor_, twist_);
  if (seen_count_ > 1 && status_ != TrackingStatus::lost) {
    note_track(seen_[seen_count_ - 1], solution_.trajectory.at(0.0), T_odom_sensor_);
  }
  const bool in_vain = !is_explained_ && chosen.size() >= kMinFeatures;
  lost_scans_ = in_vain ? lost_scans_ + 1 : 0;
  if (is_refuted(chosen)) {
    status_ = TrackingStatus::lost;
    lost_scans_ = kScansToGiveUp;
  }
  find_weak_directions();
  Estimate result = estimate(scan, solution_, chosen);
  hook(Stage::align);
  return result;
}

Solution Tracker::solve(const Scan& scan, const std::vector<Feature>& chosen, const Prior& prior) {
  if (scan_count_ == 1) return start();
  if (chosen.size() >= kMinFeatures && may_be_elsewhere()) return relocalize(scan, chosen, prior);
  return follow_turn(align_moving_or_standing(chosen, prior), chosen, prior);
}

Solution Tracker::align_moving_or_standing(const std::vector<Feature>& chosen, const Prior& prior) {
  const Solution moving = solver_.solve(chosen, maps_, prior, finest_);
  if (!standing_.is_likely()) return moving;
  const Solution standing = solver_.solve(chosen, maps_, standing_.hypothesis(prior), finest_);
  return fits_as_well(standing.structure_inliers, moving.structure_inliers) ? standing : moving;
}

void Tracker::update_map(const std::vector<Feature>& features, StageHook hook) {
  grow_map(timing_, features, solution_);
  ++scan_count_;
  if (lost_scans_ == kScansToGiveUp) {
    start_anew();
    ++restarts_;
  }
  hook(Stage::update_map);
}

/// At the start the pose is the origin by definition; of the motion only what vehicles do is known:
/// they go fast along the ground and turn about the upright, and do little else.
KnotInformation Tracker::first_information() {
  constexpr double kPose = 1e-4;  // m, rad
  constexpr double kSpeed_mps = 20.0, kClimb_mps = 0.5, kYaw_radps = 0.5, kTilt_radps = 0.1;
  Knot sigma;
  sigma << Vector6d::Constant(kPose), kTilt_radps, kTilt_radps, kYaw_radps, kSpeed_mps, kSpeed_mps,
      kClimb_mps;
  return sigma.cwiseAbs2().cwiseInverse().asDiagonal();
}

/// First to last firing, as far as the scan tells.
double Tracker::span_of(const Timing& timing) {
  constexpr double kUsual_s = 0.1;
  const double span_s = seconds(timing.end_ns - timing.start_ns);
  return span_s > 0.0 ? span_s : kUsual_s;
}

/// Whether nothing is missing between a scan and the one that ended then.
bool Tracker::follows(const Timing& scan, std::int64_t end_ns) {
  constexpr std::int64_t kNextFiring_ns = 1'000'000;
  return scan.start_ns - end_ns < kNextFiring_ns;
}

Prior Tracker::predict(const Timing& scan) const {
  const double duration_s = span_of(scan);
  const double since_s = scan_count_ == 0 ? duration_s : seconds(scan.end_ns - last_end_ns_);
  Prior prior;
  // Returns that were compensated all belong to the end: the trajectory reaches back to the last.
  prior.span_s = scan.motion_compensated ? since_s : duration_s;
  if (prior.span_s <= 0.0) prior.span_s = duration_s;
  // Longer, and it is looked for in the old map only where it was: the clock may have been set.
  const double unseen_s = since_s - prior.span_s;
  const double gap_s = unseen_s > kSearchable_s ? 0.0 : std::max(0.0, unseen_s);
  prior.T_begin = moved(T_odom_sensor_, twist_, gap_s);
  prior.twist = twist_;
  prior.acceleration_density = process_noise_.density();
  prior.begin_information = propagated(information_, prior.acceleration_density, gap_s);
  prior.segments =
      segments_for(prior.acceleration_density, prior.span_s, config_.default_profile.segments);
  return prior;
}

TrackingStatus Tracker::status_of(const Scan& scan, const Solution& solution,
                                  const std::vector<Feature>& chosen) const {
  // Of the features. A map of one scan, a tenth of an HDL-64E's, knows little of an open place.
  const double min_matched = keyframes_ < kGrown ? 0.05 : 0.2;
  constexpr double kMinWeight = 0.3;  // mean robust weight; a good alignment has 0.7 and more
  if (scan_count_ == 0) return TrackingStatus::initializing;
  const double matched = solution.matched;
  if (matched < static_cast<double>(kMinFeatures) ||
      matched < min_matched * static_cast<double>(chosen.size()) ||
      solution.inliers < kMinWeight * matched || relative_fit(solution, chosen) < kNothing) {
    return TrackingStatus::lost;
  }
  if (seen_count_ > 0 && !stands_) return TrackingStatus::initializing;  // or so it may be
  const bool is_sure = solution.converged && relative_fit(solution, chosen) > kDoubtful;
  return scan.complete && is_sure ? TrackingStatus::tracking : TrackingStatus::degraded;
}

void Tracker::observe_motion() {
  // A scan whose returns all belong to its end has no middle.
  if (timing_.motion_compensated || status_ == TrackingStatus::lost) {
    process_noise_.interrupt();
    return;
  }
  process_noise_.observe(solution_.trajectory.at(0.5),
                         timing_.start_ns + (timing_.end_ns - timing_.start_ns) / 2,
                         solution_.data_information.inverse().diagonal());
}

void Tracker::accept(const Timing& scan, const Prior& prior, const Solution& solution) {
  last_end_ns_ = scan.end_ns;
  if (scan_count_ == 0) return;
  const Eigen::Vector3d from_m = T_odom_sensor_.translation_m;
  if (status_ == TrackingStatus::lost) {
    T_odom_sensor_ = moved(prior.T_begin, prior.twist, prior.span_s);
    information_ = propagated(prior.begin_information, prior.acceleration_density, prior.span_s);
  } else {
    T_odom_sensor_ = solution.trajectory.end();
    twist_ = solution.trajectory.end_twist();
    information_ = solution.end_information;
    design_effect_ +=
        kNewest * (solution.design_effect.cwiseMax(kLeastDesignEffect) - design_effect_);
  }
  drift_.move(T_odom_sensor_.translation_m - from_m);
}

/// Whether the map led us astray: where it is known, another motion explains the scans better.
bool Tracker::is_refuted(const std::vector<Feature>& chosen) {
  if (seen_count_ > 0 || scan_count_ == 0 || status_ == TrackingStatus::lost) {
    motion_check_.clear();
    return false;
  }
  const Pose begin = timing_.motion_compensated ? T_odom_sensor_ : solution_.trajectory.at(0.0);
  motion_check_.see(chosen, begin, T_odom_sensor_, span_of(timing_), timing_.end_ns);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> by_information(
      solution_.data_information.block<2, 2>(3, 3));
  return motion_check_.is_refuted(by_information.eigenvectors().col(0));
}

void Tracker::find_weak_directions() {
  weak_ = {};
  if (scan_count_ == 0 || status_ == TrackingStatus::lost) return;
  weak_ = weak_directions(solution_.data_information, solution_.motion_information,
                          T_odom_sensor_.rotation);
  const double span_s = span_of(timing_);
  const Eigen::Vector3d along = weak_.all[0].direction.head<3>();  // m of a unit of rad and m
  constexpr double kMostlyTurns = 0.3;
  if (weak_.count == 0 || along.norm() < kMostlyTurns) {
    drift_.see(span_s);
  } else {
    drift_.coast(T_odom_sensor_.rotation * along.normalized(),
                 process_noise_.density().segment<2>(3).mean(), span_s);
  }
}

/// Of the last pose against the map: rotation, translation; odometry axes.
Matrix6d Tracker::alignment_covariance() const {
  // The error of a cell is the same for all scans that are matched with it: so many of them count
  // as one. What is the same for longer is for Drift.
  constexpr double kScansInView = 3.0;
  const double unit = kScansInView * config_.default_profile.data_weight;
  const Vector6d scale = (unit * design_effect_).cwiseSqrt();
  return scale.asDiagonal() * information_.inverse().topLeftCorner<6, 6>() * scale.asDiagonal();
}

/// Of the last pose since the first: rotation, translation; the sensor's axes.
Matrix6d Tracker::sensor_covariance() const {
  return in_sensor_axes(drift_.covariance() + alignment_covariance(), T_odom_sensor_.rotation);
}

Estimate Tracker::estimate(const Scan& scan, const Solution& solution,
                           const std::vector<Feature>& chosen) const {
  Estimate e;
  e.scan_index = scan.index;
  e.stamp_ns = scan.end_ns;
  e.T_odom_sensor = T_odom_start_ * T_odom_sensor_;
  e.twist = twist_;
  // Before the start is decided, nothing is lost yet.
  const bool starting = status_ == TrackingStatus::lost && seen_count_ > 0 && !stands_;
  e.status = starting ? TrackingStatus::initializing : status_;
  e.ground_count =
      static_cast<int>(std::count_if(chosen.begin(), chosen.end(), [](const Feature& f) {
        return f.kind == FeatureKind::ground;
      }));
  e.surface_count = static_cast<int>(chosen.size()) - e.ground_count;
  e.map_surface_count = maps_.size();
  e.map_refused_count = maps_.refused();
  e.correspondence_count = solution.matched;
  e.iterations = solution.iterations;
  e.weak_directions = weak_.all;
  e.weak_count = weak_.count;
  if (weak_.count > 0 && status_ == TrackingStatus::tracking) e.status = TrackingStatus::degraded;
  e.covariance = translation_first(sensor_covariance());
  e.has_covariance = e.covariance.allFinite();
  e.restarts = restarts_;
  e.residual_rms_sigma = std::sqrt(solution.mean_square);
  return e;
}

}  // namespace lilo::core
