// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/worlds/figures.hpp"

#include "tools/eval/report.hpp"
#include "tools/text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <numeric>
#include <stdexcept>

namespace lilo::worlds {
namespace {

void add_times(const std::string& path, Figures& figures) {
  std::ifstream file = open_text(path);
  const auto json = nlohmann::json::parse(file, nullptr, /*allow_exceptions=*/false);
  try {
    figures.cpu_p50_ms = json.at("total_ms").at("p50");
    figures.cpu_p99_ms = json.at("total_ms").at("p99");
    figures.peak_rss_mb = json.value("peak_rss_mb", kUnknown);
    if (json.contains("tenths")) figures.map_size = json["tenths"].at("map_size").at(9);
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(
        fmt::format("{}: expected what lilo run --stats writes, found: {}", path, error.what()));
  }
}

void add_trust(const Trust& trust, Figures& figures) {
  const auto& counts = trust.status_counts;
  const auto all = static_cast<double>(std::reduce(counts.begin(), counts.end()));
  const auto percent = [&](TrackingStatus status) {
    return 100.0 * static_cast<double>(counts[static_cast<std::size_t>(status)]) / all;
  };
  figures.tracking_percent = percent(TrackingStatus::tracking);
  figures.degraded_percent = percent(TrackingStatus::degraded);
  figures.lost_percent = percent(TrackingStatus::lost);
  figures.initializing_percent = percent(TrackingStatus::initializing);
  figures.nees = trust.nees.value_or(kUnknown);
  figures.nees_tracking = trust.nees_tracking.value_or(kUnknown);
  figures.false_tracking = static_cast<double>(trust.false_tracking);
  figures.sessions = trust.sessions;
}

}  // namespace

const std::array<Column, 15>& columns() {
  static constexpr std::array<Column, 15> kColumns = {{
      {"t_percent", "t %", &Figures::t_percent, 3, true},
      {"r_deg_per_100m", "deg/100 m", &Figures::r_deg_per_100m, 3, true},
      {"ate_m", "ATE m", &Figures::ate_m, 3, true},
      {"nees", "NEES", &Figures::nees, 1, true},
      {"nees_tracking", "NEES trk", &Figures::nees_tracking, 1, true},
      {"tracking_percent", "track %", &Figures::tracking_percent, 1, false},
      {"degraded_percent", "degr %", &Figures::degraded_percent, 1, false},
      {"lost_percent", "lost %", &Figures::lost_percent, 1, false},
      {"initializing_percent", "init %", &Figures::initializing_percent, 1, false},
      {"false_tracking", "false", &Figures::false_tracking, 1, true},
      {"sessions", "sess", &Figures::sessions, 1, false},
      {"cpu_p50_ms", "p50 ms", &Figures::cpu_p50_ms, 2, false},
      {"cpu_p99_ms", "p99 ms", &Figures::cpu_p99_ms, 2, false},
      {"map_size", "cells", &Figures::map_size, 0, false},
      {"peak_rss_mb", "RSS MB", &Figures::peak_rss_mb, 1, false},
  }};
  return kColumns;
}

Figures read_figures(const std::string& folder, const std::vector<double>& lengths_m) {
  constexpr int kStep = 10;  // the devkit's
  const Evaluation evaluation = evaluate(read_pose_stream(folder + "/poses.jsonl"),
                                         read_trajectory(folder + "/truth.tum"), lengths_m, kStep);
  Figures figures;
  // Below this path no error per distance is told: who turns on the spot drives none.
  constexpr double kShortestPath_m = 20.0;
  const auto& overall = evaluation.segments.overall;
  if (overall && evaluation.truth_path_m >= kShortestPath_m) {
    figures.t_percent = overall->t_percent;
    figures.r_deg_per_100m = overall->r_deg_per_100m;
  }
  figures.ate_m = evaluation.absolute_m.rmse;
  add_trust(*evaluation.trust, figures);
  add_times(folder + "/stats.json", figures);
  return figures;
}

}  // namespace lilo::worlds
