// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/paired_run.hpp"

#include "core/odometry.hpp"
#include "drivers/scan_source.hpp"
#include "tools/bench/paper/cell_run.hpp"
#include "tools/clock.hpp"

#include <fmt/format.h>

#include <memory>
#include <stdexcept>

namespace lilo {
namespace {

OdometryConfig with_profile(OdometryConfig config, Profile profile) {
  config.profile = profile;
  return config;
}

void take(Odometry& odometry, const Scan& scan, ProfileRun& run) {
  run.timer.start();
  run.timer.decoded();
  const Estimate e = odometry.process(scan, run.timer.hook());
  run.timer.finish();
  run.edges.push_back(e.edge_count);
  run.surfaces.push_back(e.surface_count);
  run.structure.push_back(e.structure_count);
  run.ground.push_back(e.ground_count);
  run.map_cells.push_back(e.map_cell_count);
  run.map_edges.push_back(e.map_edge_count);
  run.map_surfaces.push_back(e.map_surface_count);
  ++run.status_counts[static_cast<std::size_t>(e.status)];
  run.poses.push_back({e.stamp_ns, e.T_odom_sensor});
}

void add_errors(const Trajectory& truth, ProfileRun& run) {
  const Matched matched =
      associate({.name = "estimate", .has_times = true, .poses = run.poses}, truth);
  constexpr int kStep = 10;  // the KITTI devkit's
  const double path_m = travelled_m(matched.truth).back();
  if (path_m >= paper_bench::kShortestPath_m) {
    run.drift = segment_errors(matched, default_lengths_m(path_m), kStep).overall;
  }
  run.ate_m = absolute_error_m(matched).rmse;
}

}  // namespace

PairedRun run_paired(const BenchmarkSet& set, const Config& config, std::uint64_t most_scans,
                     const KeepOn& keep_on) {
  const std::unique_ptr<ScanSource> source = open_scans(set.input, config.sensor);
  Odometry by_default(with_profile(config.odometry, Profile::default_profile));
  Odometry paper(with_profile(config.odometry, Profile::paper));
  PairedRun run{.set = set.name};
  Scan scan;
  for (std::uint64_t k = 0; most_scans == 0 || k < most_scans; ++k) {
    const std::int64_t begin_ns = thread_cpu_ns();
    if (!source->next(scan)) break;
    run.decode_ms.push_back(static_cast<double>(thread_cpu_ns() - begin_ns) * 1e-6);
    run.returns.push_back(static_cast<double>(scan.returns.size()));
    run.beams = scan.beams.ring_count;
    if (k % 2 == 0) take(by_default, scan, run.default_profile);
    take(paper, scan, run.paper);
    if (k % 2 == 1) take(by_default, scan, run.default_profile);
    if (!keep_on(source->progress())) break;
  }
  if (!source->error().empty()) throw std::runtime_error(source->error());
  if (run.returns.empty()) {
    throw std::runtime_error(fmt::format("{}: expected at least one scan, found none", set.input));
  }
  if (set.truth && run.returns.size() > 1) {
    add_errors(*set.truth, run.default_profile);
    add_errors(*set.truth, run.paper);
  }
  return run;
}

}  // namespace lilo
