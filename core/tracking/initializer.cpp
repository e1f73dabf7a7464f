// SPDX-License-Identifier: BSD-3-Clause
#include "core/tracking/initializer.hpp"

#include "core/constants.hpp"
#include "core/image/selection.hpp"
#include "core/motion/motion_prior.hpp"

#include <algorithm>
#include <cmath>

namespace lilo::core {
namespace {

/// Whether a motion is not the one tracked.
bool is_elsewhere(const Twist& twist, const Twist& tracked) {
  return differ(twist, tracked, tracking::kSameVelocity_mps);
}

}  // namespace

Initializer::Initializer(std::size_t most_features, std::size_t most_for_map)
    : most_for_map_(most_for_map), search_(most_features) {
  for (Remembered& scan : scans_) {
    scan.for_map.reserve(most_for_map);
    scan.selected.reserve(most_features);
  }
}

void Initializer::clear() {
  count_ = 0;
  assumes_stationary_ = false;
  search_.clear();
}

bool Initializer::must_begin_again(const ScanTiming& scan, std::size_t feature_count,
                                   const MotionState& state) const {
  if (count_ == 0 || !state.end_ns) return false;
  // Half of a revolution: packets were lost, or the recording began in the middle of it. Or the
  // sensor was covered.
  if (feature_count > 2 * scans_[0].feature_count) return true;
  // Too long ago: only a stationary sensor surely went on as before.
  const double unseen_s = std::abs(seconds_between(*state.end_ns, scan.start_ns));
  return unseen_s > motion::kShortGap_s && (count_ == 1 || !assumes_stationary_);
}

bool Initializer::add(const Observation& scan, const std::vector<Feature>& all, bool was_lost,
                      LocalOdometry& local) {
  was_replayed_ = false;
  Remembered& one = scans_[count_++];
  one.is_room = scan.is_room;
  one.levels = scan.levels;
  one.timing = scan.timing;
  one.feature_count = all.size();
  thin_out(all, most_for_map_, Evenly::in_image, one.for_map, scan.is_room);
  one.selected.assign(scan.features->begin(), scan.features->end());
  search_.add(scan.timing, *scan.features);
  const Prior prior = local.predict(scan.timing);
  note_track(count_ - 1, prior.T_begin, predicted_end(prior));
  if (count_ <= 2) return false;
  const bool is_known =
      assumes_stationary_ ? recheck_stationary(local) : recheck_moving(was_lost, local);
  if (is_known) clear();
  return is_known;
}

void Initializer::set_track(const Pose& T_begin, const Pose& T_end) {
  note_track(count_ - 1, T_begin, T_end);
}

void Initializer::note_track(std::size_t k, const Pose& T_begin, const Pose& T_end) {
  // Returns that were compensated all belong to the end.
  tracks_[k] = {scans_[k].timing.motion_compensated ? T_end : T_begin, T_end};
}

/// The constant motion nearest to the track so far.
Twist Initializer::tracked_twist() const {
  return twist_between({}, tracks_[count_ - 1].T_end, since_first_s(count_ - 1));
}

/// From the end of the first scan to that of another; where the stamps tell none, of so many spans.
double Initializer::since_first_s(std::size_t k) const {
  const double since_s = seconds_between(scans_[0].timing.end_ns, scans_[k].timing.end_ns);
  return since_s > 0.0 ? since_s : static_cast<double>(k) * scans_[k].timing.span_s();
}

/// Adds the prior of the speed along the ground to the prediction.
void Initializer::add_velocity_prior(const Start& start, Prior& prior) {
  const double information = 1.0 / (start.sigma_mps * start.sigma_mps);
  observe_velocity(prior, prior.T_begin.rotation * start.velocity_mps,
                   {information, information, 0.0});
}

Initializer::Start Initializer::search() {
  const MotionSearch::Result found = search_.find();
  is_unambiguous_ = found.is_unambiguous;
  double sigma_mps = search::kUnknownVelocity_mps;
  if (found.moves && found.shares_enough) {
    sigma_mps = search::kSearchedVelocity_mps;
  } else if (!found.moves && is_unambiguous_) {
    sigma_mps = tracking::kSameVelocity_mps;
  }
  return {found.twist, found.twist.linear_mps, sigma_mps, found.moves};
}

/// Aligns the second scan when the sensor moved by about `start.twist` during both: the first one,
/// which alone makes the map, is deskewed by it.
Solution Initializer::try_start(const Start& start, LocalOdometry& local) {
  local.rewind(scans_[0].timing);
  Prior prior = local.predict(scans_[1].timing);
  Trajectory first;
  first.twist = start.twist;
  first.span_s = scans_[0].timing.span_s();
  first.T_begin = moved({}, start.twist, first.span_s).inverse();
  first.knots = Unknowns::Zero(Eigen::Index{kKnotSize} * (first.segments + 1));
  note_track(0, first.T_begin, {});
  local.begin_map_of(scans_[0].for_map, first, LocalMaps::finest_of(scans_[0].levels));
  prior.twist = start.twist;
  prior.T_begin = moved({}, start.twist, since_first_s(1) - prior.span_s);
  // The prior of the velocity stays that of the first round.
  add_velocity_prior(start, prior);
  return local.align(scans_[1].selected, prior);
}

/// Repeats until the motion found is the motion assumed. If the first scan is deskewed by too much,
/// the motion found is too small by as much: the first step goes half of the way, or the rounds
/// would never converge. Later steps have the length that the last one suggests (Barzilai and
/// Borwein, 1988): compensated returns need no deskewing, and all of the way is right.
Solution Initializer::refine(Start& start, LocalOdometry& local) {
  double part = tracking::kFirstPart;
  Eigen::Vector3d step_mps = Eigen::Vector3d::Zero(), last_lack_mps = step_mps;
  Solution solution = try_start(start, local);
  for (int round = 0; round < tracking::kRefiningRounds; ++round) {
    const Twist found = twist_between({}, solution.trajectory.end(), since_first_s(1));
    const Eigen::Vector3d lack_mps = found.linear_mps - start.twist.linear_mps;
    if (lack_mps.norm() < tracking::kConvergedVelocity_mps) break;
    const Eigen::Vector3d less_mps = last_lack_mps - lack_mps;
    if (round > 0 && !less_mps.isZero(0.0)) {
      part = std::clamp(step_mps.dot(less_mps) / less_mps.squaredNorm(), tracking::kLeastPart, 1.0);
    }
    step_mps = part * lack_mps;
    last_lack_mps = lack_mps;
    start.twist.linear_mps += step_mps;
    start.twist.angular_radps += part * (found.angular_radps - start.twist.angular_radps);
    solution = try_start(start, local);
  }
  return solution;
}

Solution Initializer::align_second(bool may_be_stationary, LocalOdometry& local) {
  Start start = search();
  assumes_stationary_ = is_unambiguous_ && !start.moves && may_be_stationary;
  Solution solution = refine(start, local);
  if (assumes_stationary_) local.assume_stationary();
  assumed_ = start.twist;
  return solution;
}

/// Takes all scans but the newest again, as though this motion had been known.
void Initializer::replay(Start start, LocalOdometry& local) {
  was_replayed_ = true;
  assumed_ = start.twist;
  Solution solution = refine(start, local);
  for (std::size_t k = 1; k + 1 < count_; ++k) {
    Prior prior = local.predict(scans_[k].timing);
    if (k > 1) {
      add_velocity_prior(start, prior);
      solution = local.align(scans_[k].selected, prior);
    }
    local.accept(scans_[k].timing, solution);
    note_track(k, solution.trajectory.at(0.0), solution.trajectory.end());
    const Observation scan{
        .timing = scans_[k].timing, .is_room = scans_[k].is_room, .levels = scans_[k].levels};
    local.grow_map(scan, scans_[k].for_map, solution, MapUse::keyframe);
  }
}

/// The motion under which all scans so far agree best: near the track, if it is clear that no other
/// motion fits as well.
Initializer::Start Initializer::best_start(const Twist& tracked, bool was_lost) {
  if (!is_unambiguous_ || was_lost) return search();
  // A motion that differs with all points mostly differs with a quarter of them too.
  Twist twist = search_.refine(tracked, Subsample::quarter);
  if (is_elsewhere(twist, tracked)) twist = search_.refine(tracked, Subsample::all);
  return {twist, twist.linear_mps, tracking::kSameVelocity_mps, true};
}

/// A sensor that was assumed stationary may have crept, by less in a scan than two scans can tell.
/// The motion smears a map so begun, and the map holds the sensor back later.
bool Initializer::recheck_stationary(LocalOdometry& local) {
  if (count_ < tracking::kScansToRecheck) return false;
  const Twist tracked = tracked_twist();
  if (is_elsewhere(assumed_, tracked))
    replay({tracked, tracked.linear_mps, tracking::kSameVelocity_mps, true}, local);
  return true;
}

/// Replays the scans with another motion if all of them agree better under it, or with the tracked
/// one if the map was begun under another: on bare ground two scans may tell a false motion, which
/// smears the map, and the next ones the true one.
bool Initializer::recheck_moving(bool was_lost, LocalOdometry& local) {
  const Twist tracked = tracked_twist();
  const Start other = best_start(tracked, was_lost);
  if (is_elsewhere(other.twist, tracked) &&
      search_.is_better_than_track(other.twist, std::span(tracks_).first(count_))) {
    replay(other, local);
  } else if (!was_lost && differ(assumed_, tracked, search::kSameMotion_mps)) {
    replay({tracked, tracked.linear_mps, tracking::kSameVelocity_mps, true}, local);
  }
  return count_ == search::kMotionScans;
}

}  // namespace lilo::core
