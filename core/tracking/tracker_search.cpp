#include "core/tracking/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

/// How the tracker finds the motion it was switched on in: all that a vehicle may have are tried,
/// and that is taken under which what stands takes up the least room.
namespace lilo::core {
namespace {

constexpr double kStanding_mps = 0.5;  // a robot that is switched on mostly stands
constexpr double kMoving_mps = 1.0;
constexpr double kOther_mps = 3.0, kOther_radps = 0.5;  // motions nearer to each other are the same
constexpr double kClearly = 2.0, kBeyondDoubt = 3.0;    // sigmas

}  // namespace

bool Tracker::differ(const Twist& a, const Twist& b, double mps, double radps) {
  return (a.linear_mps - b.linear_mps).norm() > mps ||
         (a.angular_radps - b.angular_radps).norm() > radps;
}

/// How compact all remembered scans are as they were tracked.
int Tracker::cells_as_tracked() {
  footprint_.clear();
  for (std::size_t k = 0; k < seen_count_; ++k) {
    Seen& one = seen_[k];
    one.plan.assign(one.outline, one.T_begin.rotation, one.T_end.rotation);
    footprint_.add(one.plan, one.T_begin.translation_m.head<2>(),
                   one.T_end.translation_m.head<2>());
  }
  return footprint_.cells();
}

/// What they take up each for itself, all together.
int Tracker::cells_alone(Share share) {
  turn(Eigen::Vector3d::Zero(), share);
  int alone = 0;
  for (std::size_t k = 0; k < seen_count_; ++k) {
    footprint_.clear();
    footprint_.add(seen_[k].plan, {0.0, 0.0}, {0.0, 0.0}, share);
    alone += footprint_.cells();
  }
  return alone;
}

/// When a remembered scan began and ended, since the first one ended.
std::pair<double, double> Tracker::since_first(const Timing& timing) const {
  const double end_s = 1e-9 * static_cast<double>(timing.end_ns - seen_[0].timing.end_ns);
  return {timing.motion_compensated ? end_s : end_s - span_of(timing), end_s};
}

/// Turns the remembered scans as though the sensor had turned so all the time.
void Tracker::turn(const Eigen::Vector3d& angular_radps, Share share) {
  for (std::size_t k = 0; k < seen_count_; ++k) {
    Seen& one = seen_[k];
    const auto [begin_s, end_s] = since_first(one.timing);
    one.plan.assign(one.outline, so3_exp(begin_s * angular_radps), so3_exp(end_s * angular_radps),
                    share);
  }
}

/// How compact they are when the sensor moved so since the first one began; after turn() by as
/// much.
Tracker::Look Tracker::look_turned(const Twist& twist, Share share) {
  footprint_.clear();
  for (std::size_t k = 0; k < seen_count_; ++k) {
    const auto [begin_s, end_s] = since_first(seen_[k].timing);
    const Eigen::Vector2d along_mps = twist.linear_mps.head<2>();
    footprint_.add(seen_[k].plan, begin_s * along_mps, end_s * along_mps, share);
  }
  return {twist, footprint_.cells()};
}

Tracker::Look Tracker::look(const Twist& twist, Share share) {
  turn(twist.angular_radps, share);
  return look_turned(twist, share);
}

Tracker::Look Tracker::look_around(const Twist& about, Share share) {
  constexpr double kTurn = 0.2;  // rad/s for each m/s: far things feel both alike
  Look best = look(about, share);
  for (const double step : {0.5, 0.25, 0.125}) {
    const Twist middle = best.twist;
    for (int turn_steps = -1; turn_steps <= 1; ++turn_steps) {
      Twist beside = middle;
      beside.angular_radps.z() += kTurn * step * turn_steps;
      turn(beside.angular_radps, share);
      for (int x = -2; x <= 2; ++x) {
        for (int y = -2; y <= 2; ++y) {
          beside.linear_mps = middle.linear_mps + step * Eigen::Vector3d(x, y, 0.0);
          const Look other = look_turned(beside, share);
          if (other.cells < best.cells) best = other;
        }
      }
    }
  }
  return best;
}

bool Tracker::speaks_for(int cells_alone, int cells, int other_cells, double sigmas) {
  const int met = meetings(cells_alone, cells, other_cells);
  return other_cells - cells > sigmas * std::sqrt(static_cast<double>(met));
}

/// A quarter of what was seen, under all motions along the ground that vehicles have: the faster,
/// the less they turn.
void Tracker::look_everywhere() {
  constexpr double kStep_mps = 1.0, kStep_radps = 0.2, kMost_mps2 = 4.0;
  constexpr int kSpeeds = 40, kHeadings = 16, kTurns = 10;
  looks_.clear();
  looks_.push_back(look({}, Share::quarter));
  for (int turns = -kTurns; turns <= kTurns; ++turns) {
    Twist twist;
    twist.angular_radps.z() = kStep_radps * turns;
    turn(twist.angular_radps, Share::quarter);
    if (turns != 0) looks_.push_back(look_turned(twist, Share::quarter));
    for (int speed = 1; speed <= kSpeeds; ++speed) {
      const double speed_mps = kStep_mps * speed;
      if (speed_mps * std::abs(twist.angular_radps.z()) > kMost_mps2) break;
      for (int heading = 0; heading < kHeadings; ++heading) {
        const double heading_rad = 2.0 * std::numbers::pi * heading / kHeadings;
        twist.linear_mps = {speed_mps * std::cos(heading_rad), speed_mps * std::sin(heading_rad),
                            0.0};
        looks_.push_back(look_turned(twist, Share::quarter));
      }
    }
  }
}

Tracker::Look Tracker::least_look() const {
  return *std::min_element(looks_.begin(), looks_.end(),
                           [](const Look& a, const Look& b) { return a.cells < b.cells; });
}

/// Leaves those motions that the quarter does not speak against, and looks at all of it under them.
void Tracker::look_closer() {
  const int alone = cells_alone(Share::quarter), least = least_look().cells;
  std::erase_if(looks_, [&](const Look& other) {
    return speaks_for(alone, least, other.cells, kBeyondDoubt);
  });
  for (Look& one : looks_) one = look(one.twist);
}

/// The motion under which the remembered scans fall on each other best. Standing, unless another is
/// clearly better.
Tracker::Start Tracker::most_compact() {
  Start start;
  start.is_clear = true;
  start.doubt_mps = kStanding_mps;
  const Look standing = look({});
  const int alone = cells_alone(Share::all);
  const int least = alone / static_cast<int>(seen_count_);  // all scans in the same cells
  if (!speaks_for(alone, least, standing.cells, kClearly)) return start;
  look_everywhere();
  look_closer();
  const Look best = least_look();
  start.is_clear = std::none_of(looks_.begin(), looks_.end(), [&](const Look& other) {
    return differ(other.twist, best.twist, kOther_mps, kOther_radps) &&
           !speaks_for(alone, best.cells, other.cells, kClearly);
  });
  if (!speaks_for(alone, best.cells, standing.cells, kClearly)) return start;
  start.moves = true;
  start.twist = look_around(best.twist, Share::all).twist;
  start.believed_mps = start.twist.linear_mps;
  start.doubt_mps = kMoving_mps;
  return start;
}

}  // namespace lilo::core
