#include "tools/plot/trajectory_view.hpp"

#include "tools/eval/report.hpp"

#include <fmt/format.h>

namespace lilo {
namespace {

Track track_of(const Trajectory& trajectory, const std::string& name) {
  Track track{name, {}};
  for (const StampedPose& pose : trajectory.poses) {
    track.positions_m.push_back(pose.pose.translation_m);
  }
  return track;
}

Track truth_track(const Trajectory& estimate, const Trajectory& truth) {
  const Matched matched = associate(estimate, truth);
  const Pose T_odom_truth = matched.estimate.front() * matched.truth.front().inverse();
  Track track{"truth", {}};
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

}  // namespace lilo
