#include "core/standard/tracker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

/// How the tracker finds the motion it was switched on in.
///
/// One scan alone tells no motion, and is bent by it. Two scans laid over each other mostly tell:
/// all speeds a vehicle may have are tried, and the one under which what stands takes up the least
/// room is refined until the motion found is the motion assumed. Where another motion fits nearly
/// as well (a road with few things beside it), nothing is called `tracking` until more scans told.
namespace lilo::standard {
namespace {

constexpr double kStanding_mps = 0.5;  // a robot that is switched on mostly stands

/// Whether `fewer` of `cells` cells is more than chance: a cell is hit or missed by a few returns.
bool is_clearly_fewer(int fewer, int cells) {
  constexpr double kSigmas = 2.0;
  return cells - fewer > kSigmas * std::sqrt(static_cast<double>(cells));
}

}  // namespace

void Tracker::remember(const std::vector<Feature>& all, const std::vector<Feature>& chosen) {
  // A first scan that saw less than half of the second is no ground to start from: packets were
  // lost, or the recording began in the middle of a turn.
  if (scan_count_ == 1 && all.size() > 2 * seen_[0].feature_count) {
    start_anew();
  }
  if (scan_count_ >= 2 && seen_count_ == 0) return;
  Seen& seen = seen_[seen_count_++];
  seen.timing = timing_;
  seen.feature_count = all.size();
  thin_out(all, seen.for_map);
  seen.chosen.assign(chosen.begin(), chosen.end());
  if (seen_count_ > 2) decide();
}

/// Gives the map up and begins another where the prediction ends: wherever the sensor is now, it is
/// not where the map knows it, and only a new map ever lets it track again.
void Tracker::start_anew() {
  drift_.begin(sensor_covariance());  // the sensor's axes are the new map's
  T_odom_start_ = T_odom_start_ * T_odom_sensor_;
  stand_at_origin();
  maps_.clear();
  seen_count_ = 0;
  scan_count_ = lost_scans_ = keyframes_ = 0;
}

void Tracker::stand_at_origin() {
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
  maps_.clear();
  hold(seen_[0].for_map, first, seen_[0].timing.end_ns);
  insert_held();
  prior.twist = start.twist;
  prior.begin_information.diagonal().segment<2>(9).setConstant(1.0 /
                                                               (start.doubt_mps * start.doubt_mps));
  // However often it is refined, what was believed at first stays believed.
  prior.begin_mean.segment<2>(9) = (start.believed_mps - start.twist.linear_mps).head<2>();
  return solver_.solve(seen_[1].chosen, maps_, prior);
}

Solution Tracker::refine(Start& start) {
  constexpr double kSpeedEnough_mps = 0.02;
  constexpr int kMaxRounds = 15;
  Solution solution = try_start(start);
  for (int round = 0; round < kMaxRounds; ++round) {
    const Twist twist = twist_between({}, solution.trajectory.end(), solution.trajectory.span_s);
    const double change_mps = (twist.linear_mps - start.twist.linear_mps).norm();
    start.twist = twist;
    solution = try_start(start);
    if (change_mps < kSpeedEnough_mps) break;
  }
  return solution;
}

Solution Tracker::start() {
  Start start = most_compact();
  Solution solution = refine(start);
  if (start.is_clear) seen_count_ = 0;
  return solution;
}

/// How compact all remembered scans are when the sensor moved so since the first one began.
int Tracker::footprint_of(const Twist& twist) {
  footprint_.clear();
  for (std::size_t k = 0; k < seen_count_; ++k) {
    const Seen& one = seen_[k];
    const double since_s = 1e-9 * static_cast<double>(one.timing.end_ns - seen_[0].timing.end_ns);
    const double span_s = one.timing.motion_compensated ? 0.0 : span_of(one.timing);
    footprint_.add(one.chosen, since_s - span_s, span_s, twist);
  }
  return footprint_.cells();
}

Tracker::Look Tracker::look(double x_mps, double y_mps) {
  Twist twist;
  twist.linear_mps = {x_mps, y_mps, 0.0};
  return {twist.linear_mps, footprint_of(twist)};
}

Tracker::Look Tracker::look_around(Look best) {
  for (const double step_mps : {0.5, 0.25, 0.125}) {
    const Eigen::Vector3d about_mps = best.v_mps;
    for (int x = -2; x <= 2; ++x) {
      for (int y = -2; y <= 2; ++y) {
        const Look other = look(about_mps.x() + x * step_mps, about_mps.y() + y * step_mps);
        if (other.cells < best.cells) best = other;
      }
    }
  }
  return best;
}

/// The motion along the ground under which the remembered scans fall on each other best, of all
/// speeds that vehicles have. Standing, unless another is clearly better.
Tracker::Start Tracker::most_compact() {
  constexpr double kStep_mps = 1.0, kOther_mps = 3.0;
  constexpr int kSpeeds = 40, kHeadings = 16;
  std::array<Look, 1 + kSpeeds * kHeadings> looks;
  looks[0] = look(0.0, 0.0);
  std::size_t n = 1;
  for (int speed = 1; speed <= kSpeeds; ++speed) {
    for (int heading = 0; heading < kHeadings; ++heading) {
      const double speed_mps = kStep_mps * speed;
      const double heading_rad = 2.0 * std::numbers::pi * heading / kHeadings;
      looks[n++] = look(speed_mps * std::cos(heading_rad), speed_mps * std::sin(heading_rad));
    }
  }
  const Look best = *std::min_element(
      looks.begin(), looks.end(), [](const Look& a, const Look& b) { return a.cells < b.cells; });
  Start start;
  start.is_clear = std::none_of(looks.begin(), looks.end(), [&](const Look& other) {
    return (other.v_mps - best.v_mps).norm() > kOther_mps &&
           !is_clearly_fewer(best.cells, other.cells);
  });
  start.doubt_mps = kStanding_mps;
  if (!is_clearly_fewer(best.cells, looks[0].cells)) return start;
  start.twist.linear_mps = start.believed_mps = look_around(best).v_mps;
  start.doubt_mps = kStep_mps;
  return start;
}

/// Takes all scans but the last through a start, as though it had been known.
void Tracker::rehearse(Start start) {
  Solution solution = refine(start);
  status_ = TrackingStatus::tracking;
  for (std::size_t k = 1; k + 1 < seen_count_; ++k) {
    const Prior prior = predict(seen_[k].timing);
    if (k > 1) solution = solver_.solve(seen_[k].chosen, maps_, prior);
    accept(seen_[k].timing, prior, solution);
    grow_map(seen_[k].timing, seen_[k].for_map, solution);
    ++scan_count_;
  }
}

/// Puts the tracker on another start where all scans so far speak for it, and makes an end of it
/// when they speak clearly or are enough.
void Tracker::decide() {
  constexpr double kOther_mps = 2.0;
  const Start compact = most_compact();
  if ((compact.twist.linear_mps - twist_.linear_mps).norm() > kOther_mps &&
      is_clearly_fewer(footprint_of(compact.twist), footprint_of(twist_))) {
    rehearse(compact);
  }
  if (compact.is_clear || seen_count_ == kScansToDecide) seen_count_ = 0;
}

}  // namespace lilo::standard
