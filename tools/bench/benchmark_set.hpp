// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/trajectory.hpp"

#include <optional>
#include <string>
#include <vector>

namespace lilo {

/// A recording and the truth about it.
struct BenchmarkSet {
  std::string name;   ///< of its folder or file; names are unique among the sets of one call
  std::string input;  ///< for open_scans()
  std::optional<Trajectory> truth;  ///< poses of the sensor; none where the folder has none
};

/// Sets by path. A capture file is a set without truth. A folder is a set when it holds
///   - data.pcap, with the truth in gt_end.tum or truth.tum,
///   - velodyne/ as a KITTI sequence, or velodyne_points/ as a KITTI raw drive (kitti_truth.hpp).
/// Any other folder stands for all the sets in it, down to four levels, by path.
/// Throws std::runtime_error, one line, when there is none or when two have one name.
std::vector<BenchmarkSet> find_sets(const std::vector<std::string>& paths);

/// The same, and a set without truth is an error.
std::vector<BenchmarkSet> find_sets_with_truth(const std::vector<std::string>& paths);

/// True poses by file, or by the folder of a set. Throws std::runtime_error.
Trajectory read_truth(const std::string& path);

}  // namespace lilo
