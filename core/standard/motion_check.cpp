#include "core/standard/motion_check.hpp"

#include <algorithm>
#include <cmath>

namespace lilo::standard {
namespace {

constexpr float kPerMetre = 2.0F;     // cells: as wide as a trunk or a post with its blur
constexpr std::uint32_t kSide = 512;  // wider than a scan, so that the grid may repeat
constexpr float kClearly = 2.0F;      // sigmas
constexpr int kOnEnd = 2;

}  // namespace

MotionCheck::MotionCheck(std::size_t most_features)
    : at_(most_features), taken_(std::size_t{kSide} * kSide / 64) {
  for (Seen& one : seen_) {
    for (std::vector<float>* part : {&one.x_cells, &one.y_cells, &one.before_s}) {
      part->reserve(most_features);
    }
  }
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
  now.end_ns = end_ns;
  for (std::vector<float>* part : {&now.x_cells, &now.y_cells, &now.before_s}) part->clear();
  // Within one scan the turn is small: the middle of it serves all, the way travelled each its own.
  const Eigen::Matrix<float, 2, 3> R =
      T_begin.rotation.slerp(0.5, T_end.rotation).toRotationMatrix().topRows<2>().cast<float>();
  const Eigen::Vector2f begin_m = T_begin.translation_m.head<2>().cast<float>();
  const Eigen::Vector2f way_m = T_end.translation_m.head<2>().cast<float>() - begin_m;
  for (const Feature& f : features) {
    if (f.kind != Kind::structure) continue;
    const Eigen::Vector2f p_m = begin_m + R * Eigen::Vector3f(f.x_m, f.y_m, f.z_m) + f.s * way_m;
    now.x_cells.push_back(kPerMetre * p_m.x());
    now.y_cells.push_back(kPerMetre * p_m.y());
    now.before_s.push_back((1.0F - f.s) * static_cast<float>(span_s));
  }
  clear_grid();
  add(now, Eigen::Vector2f::Zero());
  now.cells = cells_;
}

bool MotionCheck::is_refuted(const Eigen::Vector2d& axis) {
  if (count_ < kScans) return false;
  // In steps of about a cell in the time that all scans take. A truck drives off slowly, so that
  // the lowest speeds are passed whatever it does later.
  constexpr std::array<float, 4> kSpeeds_mps{1.0F, 2.0F, 3.0F, 4.0F};
  const Eigen::Vector2f one_mps =
      kSpeeds_mps[static_cast<std::size_t>(speed_)] * axis.cast<float>();
  const Eigen::Vector2f other_mps(-one_mps.y(), one_mps.x());
  const int tracked = cells_under(Eigen::Vector2f::Zero());
  const int least = std::min({tracked, cells_under(one_mps), cells_under(-one_mps),
                              cells_under(other_mps), cells_under(-other_mps)});
  // What tells is in how many cells scans meet, and a cell is hit or missed by a few returns.
  int met = -tracked - least;
  for (const Seen& one : seen_) met += 2 * one.cells;
  const float sigma = std::sqrt(static_cast<float>(std::max(1, met)));
  refuted_ = static_cast<float>(tracked - least) > kClearly * sigma ? refuted_ + 1 : 0;
  if (refuted_ == 0) speed_ = (speed_ + 1) % static_cast<int>(kSpeeds_mps.size());
  return refuted_ >= kOnEnd;
}

void MotionCheck::clear_grid() {
  std::fill(taken_.begin(), taken_.end(), 0);
  cells_ = 0;
}

/// The motion is the one tracked and `more_mps`, as seen from the end of the newest scan.
void MotionCheck::add(const Seen& seen, const Eigen::Vector2f& more_mps) {
  // Far from zero, so that cutting off is rounding down.
  constexpr float kFar = 64.0F * static_cast<float>(kSide);
  const float ago_s = 1e-9F * static_cast<float>(seen_[newest_].end_ns - seen.end_ns);
  const Eigen::Vector2f back = kPerMetre * more_mps;
  const float x0 = kFar - ago_s * back.x(), y0 = kFar - ago_s * back.y();
  const std::size_t n = seen.x_cells.size();
  for (std::size_t k = 0; k < n; ++k) {
    const float x = x0 + seen.x_cells[k] - seen.before_s[k] * back.x();
    const float y = y0 + seen.y_cells[k] - seen.before_s[k] * back.y();
    at_[k] = (static_cast<std::uint32_t>(static_cast<std::int32_t>(y)) % kSide) * kSide +
             static_cast<std::uint32_t>(static_cast<std::int32_t>(x)) % kSide;
  }
  for (std::size_t k = 0; k < n; ++k) {
    const std::uint64_t bit = std::uint64_t{1} << (at_[k] % 64);
    cells_ += static_cast<int>((taken_[at_[k] / 64] & bit) == 0);
    taken_[at_[k] / 64] |= bit;
  }
}

int MotionCheck::cells_under(const Eigen::Vector2f& more_mps) {
  clear_grid();
  for (const Seen& one : seen_) add(one, more_mps);
  return cells_;
}

}  // namespace lilo::standard
