// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/associate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <stdexcept>

namespace lilo {
std::optional<Pose> pose_at(const std::vector<StampedPose>& poses, std::int64_t stamp_ns) {
  if (poses.size() < 2 || stamp_ns < poses.front().stamp_ns - kMaxExtrapolation_ns ||
      stamp_ns > poses.back().stamp_ns + kMaxExtrapolation_ns) {
    return std::nullopt;
  }
  const auto later = std::upper_bound(
      poses.begin() + 1, poses.end() - 1, stamp_ns,
      [](std::int64_t stamp, const StampedPose& pose) { return stamp < pose.stamp_ns; });
  const StampedPose& b = *later;
  const StampedPose& a = *(later - 1);
  const double s =
      static_cast<double>(stamp_ns - a.stamp_ns) / static_cast<double>(b.stamp_ns - a.stamp_ns);
  return Pose{a.pose.rotation.slerp(s, b.pose.rotation),
              a.pose.translation_m + s * (b.pose.translation_m - a.pose.translation_m)};
}

namespace {

Matched by_time(const Trajectory& estimate, const Trajectory& truth) {
  Matched matched;
  for (std::size_t row = 0; row < estimate.poses.size(); ++row) {
    const StampedPose& pose = estimate.poses[row];
    if (const auto at = pose_at(truth.poses, pose.stamp_ns)) {
      matched.estimate.push_back(pose.pose);
      matched.truth.push_back(*at);
      matched.rows.push_back(row);
    } else {
      ++matched.unmatched;
    }
  }
  return matched;
}

Matched by_row(const Trajectory& estimate, const Trajectory& truth) {
  if (estimate.poses.size() != truth.poses.size()) {
    throw std::runtime_error(
        fmt::format("{} has {} poses and {} has {}: without times they are compared row by row",
                    estimate.name, estimate.poses.size(), truth.name, truth.poses.size()));
  }
  Matched matched;
  for (const StampedPose& pose : estimate.poses) matched.estimate.push_back(pose.pose);
  for (const StampedPose& pose : truth.poses) matched.truth.push_back(pose.pose);
  matched.rows.resize(estimate.poses.size());
  std::iota(matched.rows.begin(), matched.rows.end(), std::size_t{0});
  return matched;
}

}  // namespace

Matched associate(const Trajectory& estimate, const Trajectory& truth) {
  Matched matched =
      estimate.has_times && truth.has_times ? by_time(estimate, truth) : by_row(estimate, truth);
  if (matched.estimate.size() < 2) {
    throw std::runtime_error(
        fmt::format("{} and {}: expected at least two poses of the same instants, found {}",
                    estimate.name, truth.name, matched.estimate.size()));
  }
  return matched;
}

}  // namespace lilo
