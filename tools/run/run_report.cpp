// SPDX-License-Identifier: BSD-3-Clause
#include "tools/run/run_report.hpp"

#include "tools/run/statistics.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <iterator>
#include <numbers>
#include <utility>

namespace lilo {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
constexpr std::array kStatusNames = {"initializing", "tracking", "degraded", "lost"};

Json json_of(const Statistics& values) {
  return {{"mean", values.mean}, {"p50", values.p50}, {"p99", values.p99}, {"max", values.max}};
}

/// Stages in the order of the pipeline; those the odometry never reported are left out.
std::vector<std::pair<std::string, Statistics>> stage_statistics(const StageTimer& timer) {
  std::vector<std::pair<std::string, Statistics>> stages;
  stages.emplace_back("decode", statistics(timer.decode_ms()));
  for (int k = 0; k < kStageCount; ++k) {
    const auto stage = static_cast<Stage>(k);
    const Statistics values = statistics(timer.stage_ms(stage));
    if (values.max > 0.0) stages.emplace_back(to_string(stage), values);
  }
  return stages;
}

double distance_m(const OdometryRun& run) {
  std::vector<Pose> poses;
  poses.reserve(run.poses.size());
  for (const StampedPose& pose : run.poses) poses.push_back(pose.pose);
  return poses.empty() ? 0.0 : travelled_m(poses).back();
}

double real_time_factor(const OdometryRun& run) {
  return run.wall_s > 0.0 ? run.recorded_s / run.wall_s : 0.0;
}

std::string table_line(const std::string& name, const Statistics& ms) {
  return fmt::format("  {:<13}{:9.3f}{:9.3f}{:9.3f}{:9.3f}\n", name, ms.mean, ms.p50, ms.p99,
                     ms.max);
}

/// What must not grow with the way travelled.
struct Track {
  const char* key;
  const char* name;
  const std::vector<double>* values;
  double unit;
  int decimals;
};

std::array<Track, 5> tracks(const OdometryRun& run) {
  return {{{"cpu_ms_per_scan", "CPU ms", &run.timer.total_ms(), 1.0, 2},
           {"map_size", "map, 1000", &run.map_size, 1e3, 1},
           {"correspondences", "residuals", &run.correspondences, 1.0, 0},
           {"iterations", "steps", &run.iterations, 1.0, 2},
           {"rss_mb", "memory MB", &run.rss_mb, 1.0, 1}}};
}

std::string tenths_text(const OdometryRun& run) {
  if (run.poses.size() < 10) return {};
  std::string text = "mean of tenth    1";
  for (int k = 2; k <= 10; ++k) text += fmt::format("{:6}", k);
  text += "  10th/2nd\n";
  for (const Track& track : tracks(run)) {
    const auto means = means_of_tenths(*track.values);
    text += fmt::format("  {:<10}", track.name);
    for (const double mean : means)
      text += fmt::format("{:6.{}f}", mean / track.unit, track.decimals);
    text += means[1] > 0.0 ? fmt::format("{:10.3f}\n", means[9] / means[1]) : "\n";
  }
  return text;
}

std::string beams_line(const BeamEstimate& beams) {
  return fmt::format(
      "beams            corrected by up to {:.3f} deg in elevation, {:.3f} in azimuth\n",
      kDegreesPerRadian * largest_elevation_rad(beams),
      kDegreesPerRadian * largest_azimuth_rad(beams));
}

std::string tilt_line(double tilt_rad) {
  return fmt::format("tilt             {:.1f} deg against the ground of the first scan, levelled\n",
                     kDegreesPerRadian * tilt_rad);
}

std::string status_text(const OdometryRun& run) {
  std::string text;
  for (std::size_t k = 0; k < kStatusNames.size(); ++k) {
    if (run.status_counts[k] == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", run.status_counts[k], kStatusNames[k]);
  }
  return text;
}

}  // namespace

std::string to_json(const OdometryRun& run) {
  Json stages;
  for (const auto& [name, values] : stage_statistics(run.timer)) stages[name] = json_of(values);
  Json status;
  for (std::size_t k = 0; k < kStatusNames.size(); ++k) {
    status[kStatusNames[k]] = run.status_counts[k];
  }
  const Statistics total = statistics(run.timer.total_ms());
  const DriverCounts& driver = run.driver_counts;
  Json json;
  json["scans"] = run.poses.size();
  json["scans_partial"] = driver.scans_partial;
  json["packets"] = driver.data_packets;
  json["packets_lost"] = driver.packets_lost;
  json["packets_malformed"] = driver.malformed_packets;
  json["distance_m"] = distance_m(run);
  json["status"] = status;
  json["tilt_deg"] = kDegreesPerRadian * run.tilt_rad;
  json["cpu_ms_per_scan"] = total.mean;
  json["total_ms"] = json_of(total);
  json["stages_ms"] = stages;
  json["recorded_s"] = run.recorded_s;
  json["wall_s"] = run.wall_s;
  json["real_time_factor"] = real_time_factor(run);
  json["peak_rss_mb"] = run.peak_rss_mb;
  if (run.poses.size() >= 10) {
    for (const Track& track : tracks(run))
      json["tenths"][track.key] = means_of_tenths(*track.values);
  }
  return json.dump(2) + "\n";
}

std::string to_text(const OdometryRun& run) {
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "scans            {} ({})\n", run.poses.size(), status_text(run));
  const DriverCounts& driver = run.driver_counts;
  if (driver.data_packets > 0) {
    fmt::format_to(out, "packets          {}, {} lost\n", driver.data_packets, driver.packets_lost);
  }
  fmt::format_to(out, "distance         {:.2f} m\n", distance_m(run));
  if (run.beams.ring_count > 0) text += beams_line(run.beams);
  if (run.tilt_rad > 0.0) text += tilt_line(run.tilt_rad);
  text += "CPU ms a scan       mean      p50      p99      max\n";
  for (const auto& [name, values] : stage_statistics(run.timer)) text += table_line(name, values);
  text += table_line("total", statistics(run.timer.total_ms()));
  fmt::format_to(out, "real-time factor {:.1f} ({:.1f} s recorded, {:.2f} s needed)\n",
                 real_time_factor(run), run.recorded_s, run.wall_s);
  fmt::format_to(out, "peak memory      {:.0f} MB\n", run.peak_rss_mb);
  return text + tenths_text(run);
}

}  // namespace lilo
