// SPDX-License-Identifier: BSD-3-Clause
#include "core/search/motion_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lilo::core {
namespace {

constexpr std::size_t kMostHypotheses = 4096;  // more than try_all() makes

/// The motion that a displacement within a second makes of another one.
Twist changed(const Twist& twist, const Displacement& by) {
  Twist other = twist;
  other.linear_mps += Eigen::Vector3d(by.along_m.x(), by.along_m.y(), 0.0);
  other.angular_radps.z() += by.yaw_rad;
  return other;
}

}  // namespace

bool differ(const Twist& a, const Twist& b, double mps) {
  return (a.linear_mps - b.linear_mps).norm() > mps ||
         (a.angular_radps - b.angular_radps).norm() > search::kYawPerSpeed_radpm * mps;
}

MotionSearch::MotionSearch(std::size_t most_features) : grid_(most_features) {
  hypotheses_.reserve(kMostHypotheses);
  for (Scan& scan : scans_) {
    scan.structure.reserve(most_features);
    scan.points.reserve(most_features);
  }
}

void MotionSearch::clear() {
  count_ = 0;
  alone_ = {};
}

void MotionSearch::add(const ScanTiming& timing, const std::vector<Feature>& features) {
  Scan& scan = scans_[count_++];
  scan.timing = timing;
  scan.structure.assign(features);
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  for (const Subsample subsample : {Subsample::quarter, Subsample::all}) {
    scan.points.assign(scan.structure, level, level, subsample);
    grid_.clear();
    grid_.add(scan.points, {0.0, 0.0}, {0.0, 0.0}, subsample);
    alone_[static_cast<std::size_t>(subsample)] += grid_.occupied();
  }
}

/// When a scan began and ended, since the first one ended.
std::pair<double, double> MotionSearch::since_first(const ScanTiming& timing) const {
  const double end_s = seconds_between(scans_[0].timing.end_ns, timing.end_ns);
  return {timing.motion_compensated ? end_s : end_s - timing.span_s(), end_s};
}

/// Cells that the scans have in common: those that each occupies for itself, less those that all
/// occupy together.
int MotionSearch::score_of_grid(Subsample subsample) const {
  return alone_[static_cast<std::size_t>(subsample)] - grid_.occupied();
}

/// Turns the scans as though the sensor had turned so all the time.
void MotionSearch::turn(const Eigen::Vector3d& angular_radps, Subsample subsample) {
  for (Scan& scan : scans()) {
    const auto [begin_s, end_s] = since_first(scan.timing);
    scan.points.assign(scan.structure, so3_exp(begin_s * angular_radps),
                       so3_exp(end_s * angular_radps), subsample);
  }
}

/// After turn() by as much.
int MotionSearch::score_turned(const Twist& twist, Subsample subsample) {
  grid_.clear();
  const Eigen::Vector2d along_mps = twist.linear_mps.head<2>();
  for (const Scan& scan : scans()) {
    const auto [begin_s, end_s] = since_first(scan.timing);
    grid_.add(scan.points, begin_s * along_mps, end_s * along_mps, subsample);
  }
  return score_of_grid(subsample);
}

int MotionSearch::score(const Twist& twist, Subsample subsample) {
  turn(twist.angular_radps, subsample);
  return score_turned(twist, subsample);
}

int MotionSearch::score_of(std::span<const Track> tracks) {
  grid_.clear();
  for (std::size_t k = 0; k < count_; ++k) {
    const auto& [T_begin, T_end] = tracks[k];
    scans_[k].points.assign_turning(scans_[k].structure, T_begin.rotation, T_end.rotation,
                                    Subsample::all);
    grid_.add(scans_[k].points, T_begin.translation_m.head<2>(), T_end.translation_m.head<2>());
  }
  return score_of_grid(Subsample::all);
}

/// A quarter of the points, under all motions along the ground that vehicles have.
void MotionSearch::try_all() {
  hypotheses_.clear();
  hypotheses_.push_back({{}, score({}, Subsample::quarter)});
  for (int step = -search::kYawRates; step <= search::kYawRates; ++step) {
    Displacement by{.yaw_rad = search::kYawPerSpeed_radpm * search::kSpeedStep_mps * step};
    turn(changed({}, by).angular_radps, Subsample::quarter);
    const auto try_turned = [&] {
      hypotheses_.push_back({by, score_turned(changed({}, by), Subsample::quarter)});
    };
    if (step != 0) try_turned();
    for (int speed = 1; speed <= search::kSpeeds; ++speed) {
      const double speed_mps = search::kSpeedStep_mps * speed;
      if (speed_mps * std::abs(by.yaw_rad) > search::kMostAcceleration_mps2) break;
      for (int heading = 0; heading < search::kHeadings; ++heading) {
        const double heading_rad = 2.0 * std::numbers::pi * heading / search::kHeadings;
        by.along_m = {speed_mps * std::cos(heading_rad), speed_mps * std::sin(heading_rad)};
        try_turned();
      }
    }
  }
}

/// Drops the motions that are significantly worse with a quarter of the points, and scores the
/// others with all points.
void MotionSearch::keep_likely() {
  const int best = std::max_element(hypotheses_.begin(), hypotheses_.end(), has_lower_score)->score;
  std::erase_if(hypotheses_, [&](const Hypothesis& other) {
    return is_significant(best, other.score, search::kDropSigmas);
  });
  for (Hypothesis& one : hypotheses_) one.score = score(changed({}, one.by), Subsample::all);
}

MotionSearch::Result MotionSearch::find() {
  const int stationary = score({}, Subsample::all);
  const int alone = alone_[static_cast<std::size_t>(Subsample::all)];
  const int most = alone - alone / static_cast<int>(count_);  // all scans in the same cells
  if (!is_significant(most, stationary, search::kPreferSigmas)) {
    return {.is_unambiguous = is_significant(stationary, 0, search::kPreferSigmas)};
  }
  try_all();
  keep_likely();
  const Hypothesis best =
      *std::max_element(hypotheses_.begin(), hypotheses_.end(), has_lower_score);
  Result result{changed({}, best.by)};
  result.is_unambiguous =
      std::none_of(hypotheses_.begin(), hypotheses_.end(), [&](const Hypothesis& other) {
        return differ(changed({}, other.by), result.twist, search::kSameMotion_mps) &&
               !is_significant(best.score, other.score, search::kPreferSigmas);
      });
  result.moves = is_significant(best.score, stationary, search::kPreferSigmas);
  result.shares_enough = best.score > search::kLeastSearchedShare * most;
  result.twist = result.moves ? refine(result.twist, Subsample::all) : Twist{};
  return result;
}

Twist MotionSearch::refine(const Twist& about, Subsample subsample) {
  Twist best = about;
  int best_score = score(about, subsample);
  double step = search::kSpeedStep_mps;
  for (int k = 0; k < search::kRefinements; ++k) {
    step *= 0.5;
    const Twist middle = best;
    for (int yaw = -1; yaw <= 1; ++yaw) {
      Displacement by{.yaw_rad = search::kYawPerSpeed_radpm * step * yaw};
      turn(changed(middle, by).angular_radps, subsample);
      for (int x = -2; x <= 2; ++x) {
        for (int y = -2; y <= 2; ++y) {
          by.along_m = step * Eigen::Vector2d(x, y);
          const Twist other = changed(middle, by);
          const int other_score = score_turned(other, subsample);
          if (other_score <= best_score) continue;
          best = other;
          best_score = other_score;
        }
      }
    }
  }
  return best;
}

bool MotionSearch::is_better_than_track(const Twist& twist, std::span<const Track> tracks) {
  const int supposed = score(twist, Subsample::all);
  return is_significant(supposed, score_of(tracks), search::kRestartSigmas);
}

}  // namespace lilo::core
