// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/paper/cell_run.hpp"

#include "tools/csv.hpp"
#include "tools/eval/metrics.hpp"
#include "tools/run/statistics.hpp"

#include <fmt/format.h>

#include <memory>
#include <stdexcept>

namespace lilo::paper_bench {
namespace {

/// A recording whose scans may be cut in number.
class CellSource final : public ScanSource {
 public:
  CellSource(std::unique_ptr<ScanSource> source, std::uint64_t most)
      : source_(std::move(source)), most_(most) {}

  bool next(Scan& scan) override {
    if (most_ > 0 && taken_ == most_) return false;
    if (!source_->next(scan)) return false;
    ++taken_;
    return true;
  }
  [[nodiscard]] DriverCounts driver_counts() const override { return source_->driver_counts(); }
  [[nodiscard]] SourceCounts source_counts() const override { return source_->source_counts(); }
  [[nodiscard]] double progress() const override {
    return most_ > 0 ? static_cast<double>(taken_) / static_cast<double>(most_)
                     : source_->progress();
  }
  [[nodiscard]] std::string error() const override { return source_->error(); }

 private:
  std::unique_ptr<ScanSource> source_;
  std::uint64_t most_, taken_ = 0;
};

double mean(const std::vector<double>& values) { return statistics(values).mean; }

std::vector<double> sum_of(const StageTimer& timer, std::initializer_list<Stage> stages) {
  std::vector<double> sums(timer.total_ms().size(), 0.0);
  for (const Stage stage : stages) {
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += timer.stage_ms(stage)[k];
  }
  return sums;
}

/// What every scan said.
struct ScanLog {
  std::vector<double> edges, surfaces;
  std::vector<Estimate> estimates;

  void add(const Estimate& estimate) {
    edges.push_back(estimate.edge_count);
    surfaces.push_back(estimate.surface_count + estimate.ground_count);
    estimates.push_back(estimate);
  }
};

void write_scans(const std::string& path, const ScanLog& log, const StageTimer& timer) {
  const auto extraction = sum_of(timer, {Stage::project, Stage::filter, Stage::reconstruct});
  const auto pose = sum_of(timer, {Stage::deskew, Stage::align, Stage::update_map});
  CsvTable table{{"scan", "edges", "surfaces", "map_edges", "map_surfaces", "correspondences",
                  "iterations", "extraction_ms", "pose_ms"},
                 {}};
  for (std::size_t k = 0; k < log.estimates.size(); ++k) {
    const Estimate& e = log.estimates[k];
    table.rows.push_back({fmt::format("{}", e.scan_index), fmt::format("{}", log.edges[k]),
                          fmt::format("{}", log.surfaces[k]), fmt::format("{}", e.map_edge_count),
                          fmt::format("{}", e.map_surface_count),
                          fmt::format("{}", e.correspondence_count),
                          fmt::format("{}", e.iterations), fmt::format("{:.4f}", extraction[k]),
                          fmt::format("{:.4f}", pose[k])});
  }
  write_csv(path, table);
}

void add_times(const OdometryRun& run, CellResult& result) {
  const StageTimer& timer = run.timer;
  result.extraction_ms = mean(sum_of(timer, {Stage::project, Stage::filter, Stage::reconstruct}));
  result.pose_ms = mean(sum_of(timer, {Stage::deskew, Stage::align, Stage::update_map}));
  const Statistics total =
      statistics(sum_of(timer, {Stage::project, Stage::filter, Stage::reconstruct, Stage::deskew,
                                Stage::align, Stage::update_map}));
  result.total_ms = total.mean;
  result.total_p50_ms = total.p50;
  result.total_p99_ms = total.p99;
  result.total_max_ms = total.max;
}

std::string range_text(const std::vector<double>& lengths_m) {
  if (lengths_m.size() == 1) return fmt::format("{:g}", lengths_m.front());
  return fmt::format("{:g}-{:g}", lengths_m.front(), lengths_m.back());
}

}  // namespace

SetFacts look_at(const BenchmarkSet& set, const SensorConfig& sensor) {
  Scan scan;
  const std::unique_ptr<ScanSource> source = open_scans(set.input, sensor);
  if (!source->next(scan)) {
    throw std::runtime_error(
        fmt::format("{}: expected at least one complete revolution, found none", set.input));
  }
  return {scan.beams.ring_count, scan.motion_compensated};
}

void add_errors(const Trajectory& estimate, const Trajectory& truth,
                const std::vector<double>& lengths_m, CellResult& result) {
  const Matched matched = associate(estimate, truth);
  result.path_m = travelled_m(matched.truth).back();
  result.ate_m = absolute_error_m(matched).rmse;
  const auto end = [](const std::vector<Pose>& poses) -> Eigen::Vector3d {
    return (poses.front().inverse() * poses.back()).translation_m;
  };
  const Eigen::Vector3d estimated = end(matched.estimate), actual = end(matched.truth);
  result.end_x_m = estimated.x(), result.end_y_m = estimated.y(), result.end_z_m = estimated.z();
  result.true_x_m = actual.x(), result.true_y_m = actual.y(), result.true_z_m = actual.z();
  if (result.path_m < kShortestPath_m) return;
  const auto lengths = lengths_m.empty() ? default_lengths_m(result.path_m) : lengths_m;
  constexpr int kStep = 10;  // the devkit's
  const SegmentErrors errors = segment_errors(matched, lengths, kStep);
  if (!errors.overall) return;
  result.segment_lengths_m = range_text(lengths);
  result.segments = errors.overall->count;
  result.t_percent = errors.overall->t_percent;
  result.r_deg_per_100m = errors.overall->r_deg_per_100m;
}

CellResult run_cell(const Cell& cell, const BenchmarkSet& set, const SetFacts& facts,
                    const Settings& settings, const std::string& folder, const Progress& progress) {
  CellSource source(open_scans(set.input, settings.sensor), settings.most_scans);
  ScanLog log;
  const OdometryRun run =
      run_odometry(source, odometry_config(cell, facts.beams, settings.odometry),
                   [&](const Scan&, const Estimate& estimate) {
                     log.add(estimate);
                     if (!progress(source.progress())) throw Interrupted();
                   });
  if (!run.failure.empty()) throw std::runtime_error(run.failure);
  write_scans(fmt::format("{}/scans/{}.csv", folder, file_stem(cell)), log, run.timer);
  write_tum(fmt::format("{}/poses/{}.tum", folder, file_stem(cell)), run.poses);

  CellResult result{.cell = cell, .beams = facts.beams};
  result.scans = static_cast<double>(run.poses.size());
  result.not_tracked =
      static_cast<double>(run.status_counts[static_cast<std::size_t>(TrackingStatus::degraded)] +
                          run.status_counts[static_cast<std::size_t>(TrackingStatus::lost)]);
  result.edges = mean(log.edges);
  result.surfaces = mean(log.surfaces);
  add_times(run, result);
  const Trajectory estimate{.name = set.input, .has_times = true, .poses = run.poses};
  add_errors(estimate, *set.truth, settings.lengths_m, result);
  return result;
}

}  // namespace lilo::paper_bench
