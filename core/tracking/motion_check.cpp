#include "core/tracking/motion_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lilo::core {
namespace {

constexpr double kClearly = 2.0;  // sigmas
constexpr int kOnEnd = 2;
// In steps of about a cell in the time that all scans take.
constexpr std::array<double, 4> kSpeeds_mps{1.0, 2.0, 3.0, 4.0};

}  // namespace

MotionCheck::MotionCheck(std::size_t most_features) : footprint_(most_features) {
  for (Seen& one : seen_) one.plan.reserve(most_features);
  outline_.reserve(most_features);
}

void MotionCheck::clear() {
  count_ = 0;
  refuted_ = 0;
}

void MotionCheck::see(const std::vector<Feature>& features, const Pose& T_begin, const Pose& T_end,
                      double span_s, std::int64_t end_ns) {
  newest_ = (newest_ + 1) % kScans;
  count_ = std::min(count_ + 1, kScans);
  Seen& now = seen_[newest_];
  outline_.assign(features);
  now.plan.assign(outline_, T_begin.rotation, T_end.rotation);
  now.begin_m = T_begin.translation_m.head<2>();
  now.end_m = T_end.translation_m.head<2>();
  now.span_s = span_s;
  now.end_ns = end_ns;
}

MotionCheck::Looks MotionCheck::look(const Eigen::Vector2d& axis, Share share) {
  const auto cells = [&](const Eigen::Vector2d& more_mps) { return cells_under(more_mps, share); };
  Looks looks{cells(Eigen::Vector2d::Zero()), std::numeric_limits<int>::max()};
  for (const double speed_mps : kSpeeds_mps) {
    const Eigen::Vector2d one_mps = speed_mps * axis;
    const Eigen::Vector2d other_mps(-one_mps.y(), one_mps.x());
    looks.least = std::min(
        {looks.least, cells(one_mps), cells(-one_mps), cells(other_mps), cells(-other_mps)});
  }
  return looks;
}

bool MotionCheck::is_clearly_better(const Eigen::Vector2d& axis) {
  // What is clearly better with all of the scans is, but for chance, better with a quarter too.
  const Looks first = look(axis, Share::quarter);
  if (first.least >= first.tracked) return false;
  const auto [tracked, least] = look(axis, Share::all);
  int alone = 0;
  for (const Seen& one : seen_) {
    footprint_.clear();
    add(one, Eigen::Vector2d::Zero(), Share::all);
    alone += footprint_.cells();
  }
  const int met = meetings(alone, tracked, least);
  const double sigma = std::sqrt(std::max(tracked, met));  // where they hardly meet, nothing tells
  return tracked - least > kClearly * sigma;
}

bool MotionCheck::is_refuted(const Eigen::Vector2d& axis) {
  if (count_ < kScans) return false;
  refuted_ = is_clearly_better(axis) ? refuted_ + 1 : 0;
  return refuted_ >= kOnEnd;
}

/// As though the motion had been the one tracked and `more_mps`, seen from the end of the newest.
void MotionCheck::add(const Seen& one, const Eigen::Vector2d& more_mps, Share share) {
  const Seen& now = seen_[newest_];
  const double ago_s = 1e-9 * static_cast<double>(now.end_ns - one.end_ns);
  footprint_.add(one.plan, one.begin_m - now.end_m - (ago_s + one.span_s) * more_mps,
                 one.end_m - now.end_m - ago_s * more_mps, share);
}

int MotionCheck::cells_under(const Eigen::Vector2d& more_mps, Share share) {
  footprint_.clear();
  for (const Seen& one : seen_) add(one, more_mps, share);
  return footprint_.cells();
}

}  // namespace lilo::core
