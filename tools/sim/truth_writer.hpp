// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/motion.hpp"
#include "tools/sim/rotor.hpp"

#include <string>
#include <vector>

namespace lilo::sim {

/// A complete turn of the head, azimuth 0 to 360; times after the recording's start.
struct Revolution {
  double start_s = 0.0, middle_s = 0.0, end_s = 0.0;
  int packets_lost = 0;
};

/// All revolutions that lie inside [0, end_s].
std::vector<Revolution> complete_revolutions(const Rotor& rotor, double end_s);

/// What the true motion was like.
struct PathSummary {
  double length_m = 0.0, max_speed_mps = 0.0, max_accel_mps2 = 0.0, max_turn_rate_dps = 0.0;
  Vec3 end_minus_start_m = Vec3::Zero();
};

/// Writes gt_start.tum, gt_end.tum, gt_end_kitti.txt (poses at the start and end of each
/// revolution), gt_dense.tum (every 5 ms), revs.csv (its column gap counts lost packets) and
/// frame.txt (world from the frame of all others) into `folder`. All poses are of the sensor in the
/// sensor frame at the start of revolution 0; TUM stamps are UTC seconds. Throws std::runtime_error
/// when a file cannot be written.
PathSummary write_truth(const std::string& folder, const SensorPath& path,
                        const std::vector<Revolution>& revolutions, std::int64_t start_utc_ns,
                        double duration_s);

}  // namespace lilo::sim
