// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/paired_report.hpp"

#include "tools/run/statistics.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <iterator>

namespace lilo {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kStatusNames = {"initializing", "tracking", "degraded", "lost"};

struct Counter {
  const char* name;
  std::vector<double> ProfileRun::*values;
};

constexpr std::array<Counter, 7> kCounters = {{{"edges", &ProfileRun::edges},
                                               {"surfaces", &ProfileRun::surfaces},
                                               {"structure", &ProfileRun::structure},
                                               {"ground", &ProfileRun::ground},
                                               {"map cells", &ProfileRun::map_cells},
                                               {"map edges", &ProfileRun::map_edges},
                                               {"map surfaces", &ProfileRun::map_surfaces}}};

/// Mean time of the paper's profile over that of the default one.
double speed_up(const PairedRun& run) {
  const double by_default = statistics(run.default_profile.timer.total_ms()).mean;
  return by_default > 0.0 ? statistics(run.paper.timer.total_ms()).mean / by_default : 0.0;
}

std::string figures(const Statistics& s, int decimals) {
  if (s.max == 0.0) return fmt::format("{:>9}{:>9}{:>9}", "-", "-", "-");
  return fmt::format("{:9.{}f}{:9.{}f}{:9.{}f}", s.p50, decimals, s.p99, decimals, s.max, decimals);
}

std::string line(const std::string& name, const std::vector<double>& standard,
                 const std::vector<double>& paper, int decimals) {
  return fmt::format("  {:<13}{}   {}\n", name, figures(statistics(standard), decimals),
                     figures(statistics(paper), decimals));
}

std::string status_text(const ProfileRun& run) {
  std::string text;
  for (std::size_t k = 0; k < kStatusNames.size(); ++k) {
    if (run.status_counts[k] == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", run.status_counts[k], kStatusNames[k]);
  }
  return text;
}

std::string errors_text(const char* name, const ProfileRun& run) {
  std::string text = fmt::format("  {:<13}{}", name, status_text(run));
  if (run.drift) {
    text += fmt::format("; {:.2f} %, {:.2f} deg/100 m", run.drift->t_percent,
                        run.drift->r_deg_per_100m);
  }
  if (run.ate_m) text += fmt::format("; absolute error {:.3f} m", *run.ate_m);
  return text + "\n";
}

Json json_of(const Statistics& s) {
  return {{"mean", s.mean}, {"p50", s.p50}, {"p99", s.p99}, {"max", s.max}};
}

Json json_of(const ProfileRun& run) {
  Json json;
  json["total_ms"] = json_of(statistics(run.timer.total_ms()));
  for (int k = 0; k < kStageCount; ++k) {
    const auto stage = static_cast<Stage>(k);
    json["stages_ms"][to_string(stage)] = json_of(statistics(run.timer.stage_ms(stage)));
  }
  for (const Counter& counter : kCounters) {
    std::string key = counter.name;
    std::replace(key.begin(), key.end(), ' ', '_');
    json[key] = json_of(statistics(run.*counter.values));
  }
  for (std::size_t k = 0; k < kStatusNames.size(); ++k) {
    json["status"][kStatusNames[k]] = run.status_counts[k];
  }
  json["t_percent"] = run.drift ? Json(run.drift->t_percent) : Json();
  json["r_deg_per_100m"] = run.drift ? Json(run.drift->r_deg_per_100m) : Json();
  json["ate_m"] = run.ate_m ? Json(*run.ate_m) : Json();
  return json;
}

}  // namespace

std::string to_text(const PairedRun& run) {
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{}: {} scans of {} beams, {:.0f} returns each\n", run.set,
                 run.returns.size(), run.beams, statistics(run.returns).mean);
  fmt::format_to(out, "{:<15}{:>18}{:>30}\n", "", "default", "paper");
  fmt::format_to(out, "{:<15}{:>9}{:>9}{:>9}   {:>9}{:>9}{:>9}\n", "CPU ms a scan", "p50", "p99",
                 "max", "p50", "p99", "max");
  text += line("decode", run.decode_ms, run.decode_ms, 3);
  for (int k = 0; k < kStageCount; ++k) {
    const auto stage = static_cast<Stage>(k);
    text += line(to_string(stage), run.default_profile.timer.stage_ms(stage),
                 run.paper.timer.stage_ms(stage), 3);
  }
  text += line("odometry", run.default_profile.timer.total_ms(), run.paper.timer.total_ms(), 3);
  fmt::format_to(out, "  default is {:.1f} times as fast (means, {:.3f} and {:.3f} ms)\n",
                 speed_up(run), statistics(run.default_profile.timer.total_ms()).mean,
                 statistics(run.paper.timer.total_ms()).mean);
  text += "a scan\n";
  for (const Counter& counter : kCounters) {
    text += line(counter.name, run.default_profile.*counter.values, run.paper.*counter.values, 0);
  }
  text +=
      "results\n" + errors_text("default", run.default_profile) + errors_text("paper", run.paper);
  return text;
}

std::string to_json(const std::vector<PairedRun>& runs) {
  Json sets = Json::array();
  for (const PairedRun& run : runs) {
    sets.push_back({{"set", run.set},
                    {"scans", run.returns.size()},
                    {"beams", run.beams},
                    {"returns", json_of(statistics(run.returns))},
                    {"decode_ms", json_of(statistics(run.decode_ms))},
                    {"default", json_of(run.default_profile)},
                    {"paper", json_of(run.paper)},
                    {"speed_up", speed_up(run)}});
  }
  return Json{{"sets", sets}}.dump(2) + "\n";
}

}  // namespace lilo
