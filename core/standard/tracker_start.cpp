#include "core/standard/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

/// How the tracker finds the motion it was switched on in.
///
/// One scan alone tells no motion, and is bent by it. Two scans mostly tell: standing still and
/// speeds all around are tried, and the one whose scans agree best is refined until the motion
/// found is the motion assumed. Where another motion leaves as little unexplained (a road with few
/// things beside it), nothing is called `tracking` until some more scans were taken through each.
namespace lilo::standard {
namespace {

constexpr std::size_t kScansToDecide = 6;
// An open field hardly says how fast one goes; a robot that is switched on mostly stands.
constexpr double kStanding_mps = 0.5, kMoving_mps = 3.0;

}  // namespace

void Tracker::remember(const Timing& timing, const std::vector<Feature>& all,
                       const std::vector<Feature>& chosen) {
  // A first scan that saw less than half of the second is no ground to start from: packets were
  // lost, or the recording began in the middle of a turn.
  if (scan_count_ == 1 && all.size() > 2 * seen_.front().all.size()) {
    start_anew();
  }
  if (scan_count_ < 2 || !starts_.empty()) seen_.push_back({timing, all, chosen});
  if (seen_.size() == kScansToDecide) decide();
}

/// Gives the map up and begins another where the prediction ends: wherever the sensor is now, it is
/// not where the map knows it, and only a new map ever lets it track again.
void Tracker::start_anew() {
  T_odom_start_ = T_odom_start_ * T_odom_sensor_;
  stand_at_origin();
  maps_.clear();
  seen_.clear();
  starts_.clear();
  scan_count_ = lost_scans_ = keyframes_ = 0;
}

void Tracker::stand_at_origin() {
  T_odom_sensor_ = {};
  T_odom_keyframe_ = {};
  twist_ = {};
  information_ = first_information();
}

/// As after the first scan.
void Tracker::rewind() {
  stand_at_origin();
  last_end_ns_ = seen_[0].timing.end_ns;
  scan_count_ = keyframes_ = 1;
}

/// Aligns the second scan when the sensor moved by about `start.twist` during both: the first one,
/// which alone makes the map, is straightened by it.
Solution Tracker::try_start(Start& start) {
  rewind();
  Prior prior = predict(seen_[1].timing);
  Trajectory first;
  first.twist = start.twist;
  first.span_s = span_of(seen_[0].timing);
  first.T_begin = moved({}, start.twist, -first.span_s);
  first.knots = Unknowns::Zero(Eigen::Index{kKnotSize} * (first.segments + 1));
  maps_.clear();
  insert(seen_[0].all, first);
  prior.twist = start.twist;
  prior.begin_information.diagonal().segment<2>(9).setConstant(1.0 /
                                                               (start.doubt_mps * start.doubt_mps));
  // However often it is refined, what was believed at first stays believed.
  prior.begin_mean.segment<2>(9) = (start.believed_mps - start.twist.linear_mps).head<2>();
  Solution solution = solver_.solve(seen_[1].chosen, maps_, prior);
  start.inliers = solution.inliers;
  start.structure = solution.structure_inliers;
  start.misfit = solution.mean_square;
  return solution;
}

Solution Tracker::refine(Start& start, int rounds) {
  constexpr double kSpeedEnough_mps = 0.02;
  Solution solution = try_start(start);
  for (int round = 0; round < rounds; ++round) {
    const Twist twist = twist_between({}, solution.trajectory.end(), solution.trajectory.span_s);
    const double change_mps = (twist.linear_mps - start.twist.linear_mps).norm();
    start.twist = twist;
    solution = try_start(start);
    if (change_mps < kSpeedEnough_mps) break;
  }
  return solution;
}

Solution Tracker::start() {
  constexpr double kClearlyBetter = 1.05;
  constexpr int kMaxRounds = 15, kHeadings = 8;
  std::vector<Start> tried(1);
  tried[0].doubt_mps = kStanding_mps;
  try_start(tried[0]);
  std::size_t best = 0;
  for (const double speed_mps : {6.0, 12.0, 18.0, 24.0, 30.0}) {
    for (int k = 0; k < kHeadings; ++k) {
      const double heading_rad = 2.0 * std::numbers::pi * k / kHeadings;
      Start other;
      other.believed_mps = {speed_mps * std::cos(heading_rad), speed_mps * std::sin(heading_rad),
                            0.0};
      other.twist.linear_mps = other.believed_mps;
      other.doubt_mps = kMoving_mps;
      try_start(other);
      tried.push_back(other);
      if (other.inliers > kClearlyBetter * tried[best].inliers) best = tried.size() - 1;
    }
  }
  std::swap(tried[0], tried[best]);
  Start in_force = tried[0];
  starts_ = rivals(tried);
  Solution solution = refine(in_force, kMaxRounds);
  if (starts_.empty()) {
    seen_ = {};  // nothing else fits: the motion is known
  } else {
    starts_.insert(starts_.begin(), in_force);
  }
  return solution;
}

/// Of all that was tried, the few that fit about as well, and are another motion. Ground looks much
/// the same at every speed: where a motion explains more of what stands, it need not fit it better.
std::vector<Tracker::Start> Tracker::rivals(std::vector<Start> tried) {
  constexpr std::size_t kMost = 4;
  constexpr int kRounds = 5;
  constexpr double kInliers = 0.7, kMisfit = 1.1, kOther_mps = 2.0;
  const Start first = tried[0];
  std::erase_if(tried, [&](const Start& s) {
    const bool fits = s.misfit < kMisfit * first.misfit || s.structure > first.structure;
    return !fits || s.inliers < kInliers * first.inliers ||
           (s.believed_mps - first.believed_mps).norm() < kOther_mps;
  });
  std::sort(tried.begin(), tried.end(),
            [](const Start& a, const Start& b) { return a.misfit < b.misfit; });
  if (tried.size() > kMost) tried.resize(kMost);
  for (Start& s : tried) refine(s, kRounds);
  return tried;
}

/// Takes all scans but the last through a start, and sums up how the later ones fit its map.
/// Without `fill_map` only motion makes it grow: standing still, tried in vain, would hide in a map
/// that every scan fills.
void Tracker::rehearse(Start& start, bool fill_map) {
  Solution solution = try_start(start);
  start.inliers = start.structure = start.misfit = 0.0;
  status_ = TrackingStatus::tracking;
  if (!fill_map) keyframes_ = kYoung;
  for (std::size_t k = 1; k < seen_.size(); ++k) {
    const Prior prior = predict(seen_[k].timing);
    if (k > 1) {
      solution = solver_.solve(seen_[k].chosen, maps_, prior);
      start.inliers += solution.inliers;
      start.structure += solution.structure_inliers;
      start.misfit += solution.mean_square;
    }
    if (k + 1 == seen_.size()) break;
    accept(seen_[k].timing, prior, solution);
    grow_map(seen_[k].all, solution);
    ++scan_count_;
  }
}

/// Leaves the tracker as though the start that explains the first scans best had been known. Only
/// the true one explains clearly more while it leaves less unexplained, or much more of what
/// stands.
void Tracker::decide() {
  constexpr double kClearlyMore = 1.05, kMuchMore = 1.5, kAboutAsMuch = 0.8;
  for (Start& s : starts_) rehearse(s, false);
  const Start& first = starts_[0];
  Start* winner = nullptr;
  for (Start& s : starts_) {
    const bool more = s.inliers > kClearlyMore * first.inliers && s.misfit < first.misfit;
    const bool stands =
        s.structure > kMuchMore * first.structure && s.inliers > kAboutAsMuch * first.inliers;
    if ((more || stands) && (winner == nullptr || s.inliers > winner->inliers)) winner = &s;
  }
  rehearse(winner != nullptr ? *winner : starts_[0], true);
  starts_ = {};
  seen_ = {};
}

}  // namespace lilo::standard
