// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/bench/benchmark_set.hpp"
#include "tools/bench/paper/cell_result.hpp"
#include "tools/run/odometry_run.hpp"

#include <cstdint>
#include <functional>

namespace lilo::paper_bench {

/// What holds for all cells.
struct Settings {
  SensorConfig sensor;
  OdometryConfig odometry;        ///< what cells do not choose
  std::vector<double> lengths_m;  ///< of KITTI segments; empty: default_lengths_m()
  std::uint64_t most_scans = 0;   ///< of a set; 0: all
};

/// What the first scan of a set tells.
struct SetFacts {
  int beams = 0;
  bool deskewed = false;  ///< by the authors of the data set
};
SetFacts look_at(const BenchmarkSet& set, const SensorConfig& sensor);

/// Below this path no error per distance is told.
inline constexpr double kShortestPath_m = 20.0;

/// Called after every scan with the part of the set that is done; false stops the work.
using Progress = std::function<bool(double part)>;

/// Thrown when Progress said so.
struct Interrupted {};

/// Runs a cell. Writes `folder`/scans/STEM.csv (a row a scan: features, times) and
/// `folder`/poses/STEM.tum beside the result. Throws std::runtime_error or Interrupted.
CellResult run_cell(const Cell& cell, const BenchmarkSet& set, const SetFacts& facts,
                    const Settings& settings, const std::string& folder, const Progress& progress);

/// The figures of a run that compare it with the truth.
void add_errors(const Trajectory& estimate, const Trajectory& truth,
                const std::vector<double>& lengths_m, CellResult& result);

}  // namespace lilo::paper_bench
