// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/config.hpp"
#include "tools/bench/benchmark_set.hpp"
#include "tools/eval/metrics.hpp"
#include "tools/run/stage_timer.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

namespace lilo {

/// One profile on one set.
struct ProfileRun {
  StageTimer timer;  ///< of the odometry alone: its decode time is that of handing the scan over
  std::vector<double> edges, surfaces, structure, ground;  ///< features, a value a scan
  std::vector<double> map_cells, map_edges, map_surfaces;  ///< size of the map, likewise
  std::array<std::uint64_t, 4> status_counts{};            ///< scans, by TrackingStatus
  std::vector<StampedPose> poses;
  std::optional<SegmentError> drift;  ///< KITTI error; none without truth or on too short a path
  std::optional<double> ate_m;        ///< none without truth
};

/// Profile default against profile paper on one set, scan by scan: both take the same scan before
/// the next is read, and the one that went second goes first on the next one, so that neither has
/// the warmer cache or the quieter machine.
struct PairedRun {
  std::string set;
  int beams = 0;
  std::vector<double> decode_ms;  ///< reading included; once a scan, for both
  std::vector<double> returns;
  ProfileRun default_profile, paper;
};

/// Called after every scan with the part of the set that is done; false ends the run there.
using KeepOn = std::function<bool(double part)>;

/// `most_scans` 0: all. Throws std::runtime_error when the recording holds no scan or breaks off.
PairedRun run_paired(const BenchmarkSet& set, const Config& config, std::uint64_t most_scans,
                     const KeepOn& keep_on);

}  // namespace lilo
