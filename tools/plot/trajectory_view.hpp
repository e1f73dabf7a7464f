// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/plot/map_points.hpp"
#include "tools/plot/top_view.hpp"
#include "tools/trajectory.hpp"

#include <optional>
#include <string>
#include <vector>

namespace lilo {

/// A top view of estimated trajectories on their map. The truth is laid over the first of them at
/// their first common pose, so that what is seen is what the odometry drifted since; the subtitle
/// then tells the errors of the first. Throws std::runtime_error when truth and estimate have no
/// time in common.
TopView trajectory_view(const std::string& title, const std::vector<Trajectory>& estimates,
                        const std::optional<Trajectory>& truth, const MapPoints& map);

/// Says of a track what the sender said of its poses: their statuses, in their order. Another
/// session begins after a break.
void mark(Track& track, const std::vector<TrackingStatus>& statuses,
          const std::vector<int>& sessions = {});

}  // namespace lilo
