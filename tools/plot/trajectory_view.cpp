// SPDX-License-Identifier: BSD-3-Clause
#include "tools/plot/trajectory_view.hpp"

#include "tools/eval/report.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lilo {
namespace {

/// Where more than one and a half times as long passed as usual: at least one pose is missing.
std::vector<std::size_t> breaks_of(const std::vector<StampedPose>& poses) {
  std::vector<std::int64_t> steps_ns;
  for (std::size_t k = 1; k < poses.size(); ++k)
    steps_ns.push_back(poses[k].stamp_ns - poses[k - 1].stamp_ns);
  if (steps_ns.size() < 3) return {};
  std::vector<std::int64_t> sorted = steps_ns;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  std::vector<std::size_t> breaks;
  for (std::size_t k = 0; k < steps_ns.size(); ++k) {
    if (2 * steps_ns[k] > 3 * *middle) breaks.push_back(k + 1);
  }
  return breaks;
}

Track track_of(const Trajectory& trajectory, const std::string& name) {
  Track track{.name = name};
  for (const StampedPose& pose : trajectory.poses) {
    track.positions_m.push_back(pose.pose.translation_m);
  }
  if (trajectory.has_times) track.breaks = breaks_of(trajectory.poses);
  return track;
}

Track truth_track(const Trajectory& estimate, const Trajectory& truth) {
  const Matched matched = associate(estimate, truth);
  const Pose T_odom_truth = matched.estimate.front() * matched.truth.front().inverse();
  Track track{.name = "truth"};
  for (const Pose& pose : matched.truth) {
    track.positions_m.emplace_back((T_odom_truth * pose).translation_m);
  }
  return track;
}

std::string length_text(const Trajectory& trajectory) {
  std::vector<Pose> poses;
  for (const StampedPose& pose : trajectory.poses) poses.push_back(pose.pose);
  return fmt::format("{:.1f} m in {} poses", travelled_m(poses).back(), poses.size());
}

std::string error_text(const Evaluation& evaluation) {
  std::string text = fmt::format("absolute error {:.3f} m rmse", evaluation.absolute_m.rmse);
  if (const auto& overall = evaluation.segments.overall) {
    text += fmt::format(", drift {:.2f} % and {:.2f} deg / 100 m", overall->t_percent,
                        overall->r_deg_per_100m);
  }
  return text;
}

}  // namespace

TopView trajectory_view(const std::string& title, const std::vector<Trajectory>& estimates,
                        const std::optional<Trajectory>& truth, const MapPoints& map) {
  TopView view{.title = title};
  for (const Trajectory& estimate : estimates) {
    view.tracks.push_back(track_of(estimate, estimate.name));
  }
  view.points_m = map.points();
  if (estimates.empty() || estimates.front().poses.empty()) return view;
  view.subtitle = length_text(estimates.front());
  if (truth) {
    view.truth = truth_track(estimates.front(), *truth);
    view.subtitle += ", " + error_text(evaluate(estimates.front(), *truth, {}, 10));
  }
  return view;
}

void mark(Track& track, const std::vector<TrackingStatus>& statuses,
          const std::vector<int>& sessions) {
  track.statuses = statuses;
  for (std::size_t k = 1; k < sessions.size(); ++k) {
    if (sessions[k] != sessions[k - 1]) track.breaks.push_back(k);
  }
  std::sort(track.breaks.begin(), track.breaks.end());
}

}  // namespace lilo
