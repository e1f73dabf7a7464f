#include "core/standard/motion_check.hpp"

#include <algorithm>
#include <cmath>

namespace lilo::standard {
namespace {

constexpr double kClearly = 2.0;  // sigmas
constexpr int kOnEnd = 2;
// In steps of about a cell in the time that all scans take. A truck drives off slowly, so that the
// lowest speeds are passed whatever it does later.
constexpr std::array<double, 4> kSpeeds_mps{1.0, 2.0, 3.0, 4.0};

}  // namespace

MotionCheck::MotionCheck(std::size_t most_features) : footprint_(most_features) {
  for (Seen& one : seen_) one.outline.reserve(most_features);
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
  now.outline.assign(features);
  now.T_begin = T_begin;
  now.T_end = T_end;
  now.span_s = span_s;
  now.end_ns = end_ns;
  footprint_.clear();
  add(now, Eigen::Vector2d::Zero());
  now.cells = footprint_.cells();
}

bool MotionCheck::is_refuted(const Eigen::Vector2d& axis) {
  if (count_ < kScans) return false;
  const Eigen::Vector2d one_mps = kSpeeds_mps[static_cast<std::size_t>(speed_)] * axis;
  const Eigen::Vector2d other_mps(-one_mps.y(), one_mps.x());
  const int tracked = cells_under(Eigen::Vector2d::Zero());
  const int least = std::min({tracked, cells_under(one_mps), cells_under(-one_mps),
                              cells_under(other_mps), cells_under(-other_mps)});
  int alone = 0;
  for (const Seen& one : seen_) alone += one.cells;
  const int met = meetings(alone, tracked, least);
  const double sigma = std::sqrt(std::max(tracked, met));  // where they hardly meet, nothing tells
  refuted_ = tracked - least > kClearly * sigma ? refuted_ + 1 : 0;
  if (refuted_ == 0) speed_ = (speed_ + 1) % static_cast<int>(kSpeeds_mps.size());
  return refuted_ >= kOnEnd;
}

/// As though the motion had been the one tracked and `more_mps`, seen from the end of the newest.
void MotionCheck::add(const Seen& one, const Eigen::Vector2d& more_mps) {
  const Seen& now = seen_[newest_];
  const double ago_s = 1e-9 * static_cast<double>(now.end_ns - one.end_ns);
  Pose begin = one.T_begin, end = one.T_end;
  begin.translation_m -= now.T_end.translation_m;
  end.translation_m -= now.T_end.translation_m;
  begin.translation_m.head<2>() -= (ago_s + one.span_s) * more_mps;
  end.translation_m.head<2>() -= ago_s * more_mps;
  footprint_.add(one.outline, begin, end);
}

int MotionCheck::cells_under(const Eigen::Vector2d& more_mps) {
  footprint_.clear();
  for (const Seen& one : seen_) add(one, more_mps);
  return footprint_.cells();
}

}  // namespace lilo::standard
