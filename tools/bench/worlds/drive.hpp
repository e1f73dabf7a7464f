// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/bench/benchmark_set.hpp"
#include "tools/bench/worlds/world_list.hpp"

#include <atomic>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace lilo::worlds {

/// A row of the list with one seed: one recording.
struct Drive {
  World world;
  std::optional<std::uint64_t> seed;  ///< none of a row of source recording
  Role role = Role::choose;
};

/// "v_park 11", "kitti_00".
std::string label(const Drive& drive);

/// Every row whose name matches `only`, a regular expression (empty: all), with every seed of these
/// roles; row by row. Throws std::runtime_error when `only` is none.
std::vector<Drive> drives_of(const WorldList& list, const std::vector<Role>& roles,
                             const std::string& only);

/// Where recordings come from.
struct Studio {
  std::string lilo;        ///< program of source sim
  std::string velosim;     ///< that of source velosim
  std::string recordings;  ///< folder that keeps what they made: SEED/NAME/data.pcap
};

/// What cannot be had here; the text says why.
struct Skipped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Thrown when the work was stopped.
struct Interrupted {};

/// The recording of a drive with its truth, made now if it is not there. Throws Skipped where the
/// simulator or the folder is absent, Interrupted, or std::runtime_error: the simulator failed, or
/// what is there was made with other arguments.
BenchmarkSet recording_of(const Drive& drive, const Studio& studio, const std::atomic<bool>& stop);

}  // namespace lilo::worlds
