// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <iterator>
#include <numeric>
#include <utility>

namespace lilo {
namespace {

nlohmann::json summary_json(const ErrorSummary& errors) {
  return {{"rmse", errors.rmse}, {"mean", errors.mean}, {"max", errors.max}};
}

std::string segment_line(const std::string& label, const SegmentError& error) {
  return fmt::format("  {:>8}   {:8.3f} %   {:8.3f} deg/100 m   {:6d}\n", label, error.t_percent,
                     error.r_deg_per_100m, error.count);
}

std::string segment_table(const Evaluation& evaluation) {
  if (!evaluation.segments.overall) return "KITTI segments        none fits the path\n";
  std::string text = fmt::format("KITTI segments, every {}{} pose\n", evaluation.step,
                                 evaluation.step == 1   ? "st"
                                 : evaluation.step == 2 ? "nd"
                                 : evaluation.step == 3 ? "rd"
                                                        : "th");
  text += "    length   translation           rotation        count\n";
  for (const SegmentError& error : evaluation.segments.per_length) {
    text += segment_line(fmt::format("{:g} m", error.length_m), error);
  }
  return text + segment_line("all", *evaluation.segments.overall);
}

/// The figures that need no more than poses.
Evaluation of_poses(const Matched& matched, std::vector<double> lengths_m, int step) {
  Evaluation evaluation{.matched = matched.estimate.size(), .unmatched = matched.unmatched};
  evaluation.step = step;
  evaluation.estimate_path_m = travelled_m(matched.estimate).back();
  evaluation.truth_path_m = travelled_m(matched.truth).back();
  if (lengths_m.empty()) lengths_m = default_lengths_m(evaluation.truth_path_m);
  evaluation.segments = segment_errors(matched, lengths_m, step);
  evaluation.absolute_m = absolute_error_m(matched);
  evaluation.relative = relative_error(matched);
  evaluation.closure = closure(matched);
  return evaluation;
}

constexpr std::array kStatusNames = {"initializing", "tracking", "degraded", "lost"};

std::string status_text(const Trust& trust) {
  const std::uint64_t all = std::reduce(trust.status_counts.begin(), trust.status_counts.end());
  std::string text;
  for (std::size_t k = 0; k < kStatusNames.size(); ++k) {
    if (trust.status_counts[k] == 0) continue;
    text +=
        fmt::format("{}{:.1f} % {}", text.empty() ? "" : ", ",
                    100.0 * static_cast<double>(trust.status_counts[k]) / static_cast<double>(all),
                    kStatusNames[k]);
  }
  return text;
}

std::string trust_text(const Trust& trust) {
  std::string text = fmt::format("status                {}; {} session{}\n", status_text(trust),
                                 trust.sessions, trust.sessions == 1 ? "" : "s");
  text += trust.nees ? fmt::format("NEES                  {:.3g} over {} poses, 6 when right",
                                   *trust.nees, trust.nees_count)
                     : "NEES                  no pose of the first session has a covariance";
  if (trust.nees_tracking) text += fmt::format("; {:.3g} where tracking", *trust.nees_tracking);
  text += '\n';
  return text + fmt::format("false tracking        {} poses, {:.2f} % of those called tracking\n",
                            trust.false_tracking, trust.false_tracking_percent());
}

nlohmann::ordered_json trust_json(const Trust& trust) {
  nlohmann::ordered_json json;
  json["sessions"] = trust.sessions;
  for (std::size_t k = 0; k < kStatusNames.size(); ++k) {
    json["status"][kStatusNames[k]] = trust.status_counts[k];
  }
  json["nees"] = trust.nees ? nlohmann::json(*trust.nees) : nlohmann::json();
  json["nees_poses"] = trust.nees_count;
  json["nees_tracking"] =
      trust.nees_tracking ? nlohmann::json(*trust.nees_tracking) : nlohmann::json();
  json["false_tracking"] = trust.false_tracking;
  json["false_tracking_percent"] = trust.false_tracking_percent();
  return json;
}

}  // namespace

Evaluation evaluate(const Trajectory& estimate, const Trajectory& truth,
                    std::vector<double> lengths_m, int step) {
  return of_poses(associate(estimate, truth), std::move(lengths_m), step);
}

Evaluation evaluate(const PoseStream& estimate, const Trajectory& truth,
                    std::vector<double> lengths_m, int step) {
  const Matched matched = associate(trajectory(estimate), truth);
  Evaluation evaluation = of_poses(matched, std::move(lengths_m), step);
  evaluation.trust = trust(estimate, matched);
  return evaluation;
}

std::string to_text(const Evaluation& evaluation) {
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "poses compared        {}", evaluation.matched);
  if (evaluation.unmatched > 0) {
    fmt::format_to(out, " ({} outside the truth's time)", evaluation.unmatched);
  }
  fmt::format_to(out, "\npath                  {:.2f} m, truth {:.2f} m\n",
                 evaluation.estimate_path_m, evaluation.truth_path_m);
  text += segment_table(evaluation);
  const ErrorSummary& absolute = evaluation.absolute_m;
  fmt::format_to(out, "absolute error        {:.4f} m rmse, {:.4f} m mean, {:.4f} m max\n",
                 absolute.rmse, absolute.mean, absolute.max);
  const RelativeError& relative = evaluation.relative;
  fmt::format_to(
      out, "from pose to pose     {:.4f} m rmse, {:.4f} m max; {:.4f} deg rmse, {:.4f} deg max\n",
      relative.translation_m.rmse, relative.translation_m.max, relative.rotation_deg.rmse,
      relative.rotation_deg.max);
  const Closure& closure = evaluation.closure;
  fmt::format_to(out,
                 "start to end          {:.3f} m, truth {:.3f} m; error {:.3f} m, {:.3f} deg\n",
                 closure.estimate_m, closure.truth_m, closure.error_m, closure.error_deg);
  return evaluation.trust ? text + trust_text(*evaluation.trust) : text;
}

std::string to_json(const Evaluation& evaluation) {
  nlohmann::ordered_json per_length = nlohmann::ordered_json::array();
  for (const SegmentError& error : evaluation.segments.per_length) {
    per_length.push_back({{"length_m", error.length_m},
                          {"count", error.count},
                          {"t_percent", error.t_percent},
                          {"r_deg_per_100m", error.r_deg_per_100m}});
  }
  nlohmann::ordered_json json;
  json["poses"] = evaluation.matched;
  json["poses_outside_truth"] = evaluation.unmatched;
  json["path_m"] = evaluation.estimate_path_m;
  json["truth_path_m"] = evaluation.truth_path_m;
  const auto& overall = evaluation.segments.overall;
  json["segments"] = overall ? overall->count : 0;
  json["t_percent"] = overall ? nlohmann::json(overall->t_percent) : nlohmann::json();
  json["r_deg_per_100m"] = overall ? nlohmann::json(overall->r_deg_per_100m) : nlohmann::json();
  json["per_length"] = per_length;
  json["ate_m"] = summary_json(evaluation.absolute_m);
  json["rpe_translation_m"] = summary_json(evaluation.relative.translation_m);
  json["rpe_rotation_deg"] = summary_json(evaluation.relative.rotation_deg);
  json["closure"] = {{"estimate_m", evaluation.closure.estimate_m},
                     {"truth_m", evaluation.closure.truth_m},
                     {"error_m", evaluation.closure.error_m},
                     {"error_deg", evaluation.closure.error_deg}};
  if (evaluation.trust) json["trust"] = trust_json(*evaluation.trust);
  return json.dump(2) + "\n";
}

}  // namespace lilo
