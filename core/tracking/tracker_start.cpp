#include "core/tracking/tracker.hpp"

#include <algorithm>
#include <cmath>

/// How the tracker starts in motion.
///
/// One scan alone tells no motion, and is bent by it. Two scans laid over each other mostly tell
/// (tracker_search.cpp): the motion under which what stands takes up the least room is refined
/// until the motion found is the motion assumed. Where another motion fits nearly as well (a road
/// with few things beside it), nothing is called `tracking` until more scans told.
namespace lilo::core {
namespace {

constexpr double kNearer_mps = 0.25;  // to the motion tracked so far
constexpr double kProbably = 1.0;     // sigmas

}  // namespace

/// Whether the scans so far are no ground to start from.
bool Tracker::is_start_vain(std::size_t feature_count) const {
  if (scan_count_ == 0 || seen_count_ == 0) return false;
  // Half of a turn: packets were lost, or the recording began in the middle of it.
  if (scan_count_ == 1 && feature_count > 2 * seen_[0].feature_count) return true;
  // Long ago: only who stood may be supposed to have gone on as it did.
  const double unseen_s = 1e-9 * std::abs(static_cast<double>(timing_.start_ns - last_end_ns_));
  return unseen_s > kUnseen_s && (scan_count_ == 1 || !stands_);
}

void Tracker::remember(const std::vector<Feature>& all, const std::vector<Feature>& chosen) {
  if (is_start_vain(all.size())) start_anew();
  if (scan_count_ >= 2 && seen_count_ == 0) return;
  Seen& seen = seen_[seen_count_++];
  seen.timing = timing_;
  seen.feature_count = all.size();
  thin_out(all, for_map(), seen.for_map);
  seen.chosen.assign(chosen.begin(), chosen.end());
  seen.outline.assign(chosen);
  note_prediction(seen);
  if (seen_count_ <= 2) return;
  if (stands_) {
    doubt_standing();
  } else {
    decide();
  }
}

/// Gives the map up and begins another where the prediction ends: wherever the sensor is now, it is
/// not where the map knows it, and only a new map ever lets it track again.
void Tracker::start_anew() {
  drift_.begin(sensor_covariance());  // the sensor's axes are the new map's
  T_odom_start_ = T_odom_start_ * T_odom_sensor_;
  stand_at_origin();
  maps_.clear();
  seen_count_ = 0;
  usual_fit_ = 0.0;
  scan_count_ = lost_scans_ = keyframes_ = 0;
}

void Tracker::stand_at_origin() {
  standing_.end();
  process_noise_.interrupt();
  T_odom_sensor_ = {};
  T_odom_keyframe_ = {};
  held_.waiting = false;
  drift_.rewind();
  twist_ = {};
  information_ = first_information();
}

/// As after the first scan.
void Tracker::rewind() {
  stand_at_origin();
  last_end_ns_ = seen_[0].timing.end_ns;
  scan_count_ = keyframes_ = 1;
}

/// Adds what is believed of the speed along the ground to what the prediction knows of it.
void Tracker::believe(const Start& start, Prior& prior) {
  const Eigen::Vector3d predicted_mps = prior.T_begin.rotation * prior.twist.linear_mps;
  const double weight = 1.0 / (start.doubt_mps * start.doubt_mps);
  KnotInformation both = prior.begin_information;
  both.diagonal().segment<2>(9).array() += weight;
  Knot pull = prior.begin_information * prior.begin_mean;
  pull.segment<2>(9) += weight * (start.believed_mps - predicted_mps).head<2>();
  prior.begin_mean = both.ldlt().solve(pull);
  prior.begin_information = both;
}

/// Aligns the second scan when the sensor moved by about `start.twist` during both: the first one,
/// which alone makes the map, is straightened by it.
Solution Tracker::try_start(const Start& start) {
  rewind();
  Prior prior = predict(seen_[1].timing);
  Trajectory first;
  first.twist = start.twist;
  first.span_s = span_of(seen_[0].timing);
  first.T_begin = moved({}, start.twist, -first.span_s);
  first.knots = Unknowns::Zero(Eigen::Index{kKnotSize} * (first.segments + 1));
  note_track(seen_[0], first.T_begin, {});
  maps_.clear();
  hold(seen_[0].for_map, first, seen_[0].timing.end_ns);
  insert_held();
  prior.twist = start.twist;
  // However often it is refined, what was believed at first stays believed.
  believe(start, prior);
  return solver_.solve(seen_[1].chosen, maps_, prior);
}

/// Until the motion found is the motion assumed. What the first scan is straightened by too much
/// the second lacks, and the other way round: half of the way at first, or they would never meet.
/// From then on as far as the last step tells to go (Barzilai and Borwein, 1988): compensated
/// returns need no straightening, and all of the way is right.
Solution Tracker::refine(Start& start) {
  constexpr double kSpeedEnough_mps = 0.01;
  constexpr int kMaxRounds = 15;
  double part = 0.5;
  Eigen::Vector3d step_mps = Eigen::Vector3d::Zero(), last_lack_mps = step_mps;
  Solution solution = try_start(start);
  for (int round = 0; round < kMaxRounds; ++round) {
    const Twist found = twist_between({}, solution.trajectory.end(), solution.trajectory.span_s);
    const Eigen::Vector3d lack_mps = found.linear_mps - start.twist.linear_mps;
    if (lack_mps.norm() < kSpeedEnough_mps) break;
    const Eigen::Vector3d less_mps = last_lack_mps - lack_mps;
    if (round > 0 && !less_mps.isZero(0.0)) {
      part = std::clamp(step_mps.dot(less_mps) / less_mps.squaredNorm(), 0.25, 1.0);
    }
    step_mps = part * lack_mps;
    last_lack_mps = lack_mps;
    start.twist.linear_mps += step_mps;
    start.twist.angular_radps += part * (found.angular_radps - start.twist.angular_radps);
    solution = try_start(start);
  }
  return solution;
}

Solution Tracker::start() {
  Start start = most_compact();
  Solution solution = refine(start);
  start_is_clear_ = start.is_clear;
  // Who was switched on mostly stands; where a map was given up, more scans must tell.
  stands_ = start.is_clear && !start.moves && restarts_ == 0;
  if (stands_) standing_.begin({});
  assumed_twist_ = start.twist;
  return solution;
}

void Tracker::note_prediction(Seen& seen) const {
  const Prior prior = predict(seen.timing);
  note_track(seen, prior.T_begin, moved(prior.T_begin, prior.twist, prior.span_s));
}

void Tracker::note_track(Seen& seen, const Pose& T_begin, const Pose& T_end) {
  // Returns that were compensated all belong to the end.
  seen.T_begin = seen.timing.motion_compensated ? T_end : T_begin;
  seen.T_end = T_end;
}

/// Takes all scans but the newest through a start, as though it had been known.
void Tracker::rehearse(Start start) {
  Solution solution = refine(start);
  status_ = TrackingStatus::tracking;
  for (std::size_t k = 1; k + 1 < seen_count_; ++k) {
    Prior prior = predict(seen_[k].timing);
    if (k > 1) {
      believe(start, prior);
      solution = solver_.solve(seen_[k].chosen, maps_, prior);
    }
    accept(seen_[k].timing, prior, solution);
    note_track(seen_[k], solution.trajectory.at(0.0), solution.trajectory.end());
    grow_map(seen_[k].timing, seen_[k].for_map, solution);
    ++scan_count_;
  }
}

/// Whether a motion is not the one tracked.
bool Tracker::is_elsewhere(const Twist& twist, const Twist& tracked) {
  constexpr double kApart_mps = 0.5, kApart_radps = 0.1;
  return differ(twist, tracked, kApart_mps, kApart_radps);
}

/// The constant motion nearest to the track so far.
Twist Tracker::twist_so_far() const {
  const Seen& newest = seen_[seen_count_ - 1];
  const double so_far_s = 1e-9 * static_cast<double>(newest.timing.end_ns - seen_[0].timing.end_ns);
  return twist_between({}, newest.T_end, so_far_s);
}

/// The motion that all scans so far speak for: near the track, once it is clear that there is none
/// like it elsewhere.
Tracker::Start Tracker::best_start(const Twist& tracked) {
  if (start_is_clear_ && status_ != TrackingStatus::lost) {
    Start start;
    // What lies elsewhere with all of what was seen does, but for chance, with a quarter of it too.
    start.twist = look_around(tracked, Share::quarter).twist;
    if (is_elsewhere(start.twist, tracked)) start.twist = look_around(tracked, Share::all).twist;
    start.believed_mps = start.twist.linear_mps;
    start.doubt_mps = kNearer_mps;
    return start;
  }
  Start start = most_compact();
  start_is_clear_ = start.is_clear;
  return start;
}

/// Who was taken to stand may have been driving off slowly, where a step of a scan is less than the
/// scans can tell: a map so begun is smeared by it, and holds the sensor back later.
void Tracker::doubt_standing() {
  constexpr std::size_t kEnough = 4;  // scans
  if (seen_count_ < kEnough) return;
  const Twist tracked = twist_so_far();
  if (is_elsewhere(assumed_twist_, tracked)) {
    rehearse({tracked, tracked.linear_mps, kNearer_mps});
  }
  seen_count_ = 0;
}

/// Puts the tracker on another start where all scans so far speak for it, and makes an end of it
/// when they are enough.
void Tracker::decide() {
  const Twist tracked = twist_so_far();
  const Start other = best_start(tracked);
  if (is_elsewhere(other.twist, tracked) &&
      speaks_for(cells_alone(Share::all), look(other.twist).cells, cells_as_tracked(), kProbably)) {
    rehearse(other);
  }
  if (seen_count_ == kScansToDecide) seen_count_ = 0;
}

}  // namespace lilo::core
