// SPDX-License-Identifier: BSD-3-Clause
#include "core/tracking/tracker.hpp"

#include "core/constants.hpp"
#include "core/motion/motion_prior.hpp"
#include "core/registration/weak_directions.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <optional>

namespace lilo::core {
namespace {

/// The horizontal direction of which the scan tells least: along a road or across it.
Eigen::Vector2d least_known_axis(const Solution& solution) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> by_information(
      solution.data_information.block<2, 2>(3, 3));
  return by_information.eigenvectors().col(0);
}

/// Whether the sensor can have the velocity at the end of the solution. Where a scan is all but
/// covered, what is left may match at any height, and the next predictions would fly off.
/// `unseen_s`: AlignmentHistory::unseen_s().
bool has_possible_velocity(const Solution& solution, const Prior& prior, double unseen_s) {
  const Twist end = solution.trajectory.end_twist();
  return (end.linear_mps - prior.twist.linear_mps).norm() <=
         motion::kImpossibleAcceleration_mps2 * (unseen_s + prior.span_s);
}

bool is_motion_doubtful(const MotionCheck& check, const TallStructure& tall) {
  return check.is_ambiguous() || tall.disagrees();
}

/// Whether that is so, or was so and nothing confirms the motion since.
bool may_follow_traffic(const MotionCheck& check, const TallStructure& tall) {
  return is_motion_doubtful(check, tall) || tall.is_missing();
}

/// Whether an alignment found too little of the scan in the map. `fit`: StructureFit::relative().
bool matches_too_little(const Solution& solution, double fit) {
  // A number, not a part of the features: in a park a fifth of them may match in a good alignment.
  return static_cast<std::size_t>(solution.matched) < tracking::kMinFeatures ||
         fit < registration::kChanceFit;
}

}  // namespace

Tracker::Tracker(const OdometryConfig& config)
    : selection_(config.default_profile.ground_features, config.default_profile.structure_features),
      local_(config.default_profile, selection_.most()),
      initializer_(selection_.most(),
                   static_cast<std::size_t>(config.default_profile.map_features)),
      relocalizer_(selection_.most()),
      motion_check_(selection_.most()),
      calibrates_(config.default_profile.calibrate_beams) {}

void Tracker::resume_beams(const BeamEstimate& kept) {
  if (calibrates_) calibration_.resume(kept);
}

Estimate Tracker::align(const Scan& scan, const BeamTable& beams, std::vector<Feature>& features,
                        StageHook hook) {
  calibration_.begin_scan(beams);
  local_.set_sensitivity(calibration_.sensitivity());
  if (calibrates_) calibration_.correction().apply(features);
  beams_ = beams;
  // In rooms little of the floor is seen, and ceilings hold height and attitude as well. Elsewhere
  // flat surfaces overhead are mostly canopies.
  scan_ = observe(scan, selection_.choose(features, scan_.is_room));
  // Half cells may give information along a direction that is weak with whole ones: they tell the
  // lamps of a tunnel from its lining.
  if (alignment_.weak.count > 0 && !scan_.is_room) scan_.levels = Levels::from_half;
  hook(Stage::filter);
  if (session_.is_over) begin_session(/*may_be_stationary=*/false);
  Prior prior = begin_scan(features);
  std::optional<Solution> solution = solve(prior);
  if (!solution) {
    begin_session(/*may_be_stationary=*/false);
    prior = begin_scan(features);
    solution = solve(prior);
  }
  alignment_ = judge(*solution);
  accept(prior);
  watch_session();
  if (!is_first() && !is_lost()) {
    alignment_.weak = local_.find_weak_directions(
        scan_.timing, alignment_.solution, may_follow_traffic(motion_check_, tall_structure_));
  }
  confirm();
  Estimate result = estimate(scan);
  hook(Stage::align);
  return result;
}

void Tracker::update_map(const std::vector<Feature>& features, StageHook hook) {
  const MapUse use = is_lost()                 ? MapUse::none
                     : alignment_.is_explained ? MapUse::keyframe
                                               : MapUse::end_only;
  if (use == MapUse::keyframe) calibrate();
  // The result counts from the next scan on: the pose of this one is out.
  if (is_checked()) {
    motion_check_.observe_ambiguity(least_known_axis(alignment_.solution),
                                    is_any_dead_reckoned(alignment_.weak));
  }
  local_.grow_map(scan_, features, alignment_.solution, use);
  hook(Stage::update_map);
}

/// Not in rooms: little of the floor is seen there.
void Tracker::calibrate() {
  const Eigen::Vector3d& place_m = local_.state().T_odom_sensor.translation_m;
  const bool is_sure = phase_ == Phase::tracking && alignment_.solution.converged &&
                       !scan_.is_room && !session_.is_over &&
                       !is_motion_doubtful(motion_check_, tall_structure_);
  if (!calibrates_ || !is_sure || !calibration_.is_due(place_m)) return;
  calibration_.observe(local_.beam_equations(*scan_.features, alignment_.solution.trajectory,
                                             calibration_.sensitivity()),
                       beams_, place_m);
  if (const auto rigid = calibration_.rebase()) local_.subtract_sensitivity(*rigid);
  local_.set_sensitivity(calibration_.sensitivity());
  local_.set_beam_covariance(calibration_.pose_covariance());
}

/// Gives the map up and begins another one where the prediction ends. The sensor is not where the
/// map has it, or how it moved since the map was begun is not known.
void Tracker::begin_session(bool may_be_stationary) {
  session_ = {.T_odom_start = session_.T_odom_start * local_.begin_map(scan_.timing),
              .restarts = session_.restarts + 1,
              .may_be_stationary = may_be_stationary};
  initializer_.clear();
  calibration_.begin_map();
  local_.set_sensitivity(calibration_.sensitivity());
  motion_check_.clear();  // an ambiguity of the old map must not end the new session
  confirmation_ = {};
  tall_structure_.forget_scans();
  history_.fit = start_fit_ = {};
  phase_ = Phase::starting;
}

/// Sets the phase, and predicts the motion of the scan.
Prior Tracker::begin_scan(const std::vector<Feature>& features) {
  if (phase_ == Phase::starting) {
    if (initializer_.must_begin_again(scan_.timing, features.size(), local_.state())) {
      begin_session(session_.may_be_stationary);
    }
    const bool was_lost = is_lost();
    const bool is_known = initializer_.add(scan_, features, was_lost, local_);
    if (initializer_.was_replayed()) {  // what was found so far was found with a false map
      confirmation_ = {};
      tall_structure_.forget_scans();
    }
    if (!is_known) return local_.predict(scan_.timing);
    history_.fit = start_fit_;
  }
  phase_ = history_.unseen_s(scan_.timing) > motion::kShortGap_s ? Phase::lost : Phase::tracking;
  return local_.predict(scan_.timing);
}

/// Where the sensor comes through a wall or out of foliage, it may see nothing that it saw before
/// but the other sides. They hold the sensor until the map knows more.
Solution Tracker::align_from_prediction(const Prior& prior) {
  Solution found = local_.align(*scan_.features, prior, scan_.levels);
  if (phase_ == Phase::starting) return found;
  const double fit = history_.fit.relative(found, scan_.structure);
  if (!matches_too_little(found, fit) && fit > registration::kDoubtfulFit) return found;
  return local_.align(*scan_.features, prior, scan_.levels, Sides::both);
}

/// None where the session is to end.
std::optional<Solution> Tracker::solve(const Prior& predicted) {
  if (initializer_.scans() == 2) {
    return initializer_.align_second(session_.may_be_stationary, local_);
  }
  if (phase_ == Phase::lost && scan_.says_enough()) {
    return relocalize(local_.align(*scan_.features, predicted, scan_.levels), predicted);
  }
  const Solution found = align_from_prediction(predicted);
  if (phase_ == Phase::starting) return found;
  const Solution turned = relocalizer_.follow_turn(found, scan_, predicted, history_, local_);
  const bool is_possible =
      has_possible_velocity(turned, predicted, history_.unseen_s(scan_.timing));
  return is_possible ? turned : local_.unaligned(predicted);
}

/// The prediction, if the sensor is not found. None if it was unseen for longer than the search
/// reaches: the old map always has some place that looks like the new one. Two cases are exempt:
/// the clock was set, so that the sensor is where it was predicted; and a stationary sensor is
/// waited for while scans are missing or poor.
std::optional<Solution> Tracker::relocalize(const Solution& at_prediction, const Prior& prior) {
  const auto is_predicted = [&](const Solution& solution) {
    return is_in_place(solution, prior, history_.fit.relative(solution, scan_.structure));
  };
  const double unseen_s = history_.unseen_s(scan_.timing);
  const bool is_searchable = unseen_s <= motion::kLongestGap_s;
  if (!is_searchable && !local_.is_stationary() && !is_predicted(at_prediction)) {
    // No map should begin with a fragment: a cover may be taken off in the middle of a revolution.
    if (history_.was_covered) return local_.unaligned(prior);
    return std::nullopt;
  }
  const std::optional<Solution> found =
      relocalizer_.find(scan_, prior, at_prediction, history_, local_);
  const bool is_found =
      found && !matches_too_little(*found, history_.fit.relative(*found, scan_.structure)) &&
      has_possible_velocity(*found, prior, unseen_s) && (is_searchable || is_predicted(*found));
  return is_found ? *found : local_.unaligned(prior);
}

Tracker::Alignment Tracker::judge(const Solution& solution) const {
  Alignment a{.solution = solution};
  if (is_first()) return a;
  const double fit = history_.fit.relative(solution, scan_.structure);
  if (matches_too_little(solution, fit)) {
    a.status = TrackingStatus::lost;
    a.is_explained = false;
    return a;
  }
  a.is_explained = is_explained(solution, fit);
  a.is_good = solution.converged && fit > registration::kDoubtfulFit;
  if (phase_ == Phase::starting && !initializer_.assumes_stationary()) return a;  // or so it may be
  a.status = a.is_good && scan_.is_complete ? TrackingStatus::tracking : TrackingStatus::degraded;
  return a;
}

void Tracker::accept(const Prior& prior) {
  const Solution& solution = alignment_.solution;
  history_.was_covered = !scan_.says_enough();
  history_.is_doubtful =
      history_.fit.relative(solution, scan_.structure) < registration::kDoubtfulFit;
  if (alignment_.is_explained) {
    history_.end_ns = scan_.timing.end_ns;
    if (phase_ == Phase::starting) {
      start_fit_ = {};  // more fits the young map from scan to scan, so that the newest one counts
      start_fit_.learn(solution, scan_.structure);
    } else {
      history_.fit.learn(solution, scan_.structure);
    }
  }
  // A scan with compensated returns has no middle. One that has not converged is farther off than
  // its information says, and the noise would grow by its errors.
  const bool tells_noise = solution.converged && !is_lost() && !scan_.timing.motion_compensated;
  if (tells_noise) {
    local_.observe_noise(scan_.timing, solution);
  } else {
    local_.interrupt_noise();
  }
  if (is_first()) {
    local_.accept_first(scan_.timing);
  } else if (is_lost()) {
    local_.accept_prediction(scan_.timing, prior);
  } else {
    local_.accept(scan_.timing, solution);
    if (phase_ == Phase::starting) {
      initializer_.set_track(solution.trajectory.at(0.0), local_.state().T_odom_sensor);
    }
  }
  if (!is_lost()) local_.observe_stationary();
}

/// Scans before a gap, or before the clock was set, cannot be laid over this one.
bool Tracker::is_checked() const { return phase_ == Phase::tracking && !is_lost(); }

/// Takes the scan. Returns whether another motion explains the last scans better.
bool Tracker::check_motion() {
  if (!is_checked()) {
    motion_check_.clear();
    return false;
  }
  const Solution& solution = alignment_.solution;
  const Pose& T_end = local_.state().T_odom_sensor;
  const Pose T_begin = scan_.timing.motion_compensated ? T_end : solution.trajectory.at(0.0);
  motion_check_.add(*scan_.features, T_begin, T_end, scan_.timing);
  return motion_check_.compare(least_known_axis(solution));
}

/// Checks the motion, and decides whether the session is over.
void Tracker::watch_session() {
  if (alignment_.is_explained) {
    session_.unexplained_scans = 0;
  } else if (scan_.says_enough()) {
    ++session_.unexplained_scans;
  }
  alignment_.is_refuted = check_motion();
  if (alignment_.is_refuted) {
    alignment_.status = TrackingStatus::lost;
  } else if (motion_check_.ambiguity_ended() && alignment_.status == TrackingStatus::tracking) {
    alignment_.status = TrackingStatus::degraded;
  }
  tall_structure_.observe(tall_equations(alignment_.solution, is_lost(), scan_.is_room),
                          motion_check_.is_ambiguous() || alignment_.is_refuted,
                          scan_.timing.end_ns);
  session_.is_over = alignment_.is_refuted || motion_check_.ambiguity_ended() ||
                     session_.unexplained_scans == tracking::kScansToGiveUp;
}

void Tracker::confirm() {
  const bool is_good = alignment_.is_good && alignment_.weak.count == 0 &&
                       !may_follow_traffic(motion_check_, tall_structure_) &&
                       !degenerate_direction(alignment_.solution.data_information);
  confirmation_.add(is_good);
  // A sensor that was just switched on, and is stationary, is believed at once.
  if (is_good && initializer_.assumes_stationary()) confirmation_.confirm();
}

Estimate Tracker::estimate(const Scan& scan) const {
  const Solution& solution = alignment_.solution;
  const LocalMaps& cells = local_.map().cells();
  Estimate e;
  e.scan_index = scan.index;
  e.stamp_ns = scan.end_ns;
  e.T_odom_sensor = session_.T_odom_start * local_.reported().T_odom_sensor;
  e.twist = local_.reported().twist;
  // Before the initial motion is known, nothing is lost yet.
  const bool is_unknown = phase_ == Phase::starting && !initializer_.assumes_stationary();
  e.status = is_lost() && is_unknown ? TrackingStatus::initializing : alignment_.status;
  e.structure_count = static_cast<int>(scan_.structure);
  e.ground_count = static_cast<int>(scan_.features->size()) - e.structure_count;
  e.map_cell_count = cells.size();
  e.map_refused_count = cells.refused();
  e.correspondence_count = solution.matched;
  e.iterations = solution.iterations;
  const WeakDirections& weak = alignment_.weak;
  e.weak_directions = weak.all;
  e.weak_count = weak.count;
  e.is_motion_doubtful = is_motion_doubtful(motion_check_, tall_structure_);
  e.is_uncertain = !is_lost() && local_.is_uncertain();
  e.is_confirmed = confirmation_.is_confirmed();
  const bool is_doubtful =
      weak.count > 0 || e.is_motion_doubtful || e.is_uncertain || !e.is_confirmed;
  if (is_doubtful && e.status == TrackingStatus::tracking) e.status = TrackingStatus::degraded;
  e.covariance = translation_first(local_.covariance());
  e.has_covariance = e.covariance.allFinite();
  e.restarts = session_.restarts;
  e.residual_rms_sigma = std::sqrt(solution.mean_square);
  return e;
}

std::vector<Eigen::Vector3f> Tracker::map_points() const {
  const LocalMaps& cells = local_.map().cells();
  std::vector<Eigen::Vector3f> points_m;
  points_m.reserve(static_cast<std::size_t>(cells.size()));
  cells.for_each_mean([&](const Eigen::Vector3d& mean_m) {
    points_m.emplace_back((session_.T_odom_start * mean_m).cast<float>());
  });
  return points_m;
}

}  // namespace lilo::core
