// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/trajectory.hpp"

#include <optional>
#include <vector>

namespace lilo {

/// Estimate and truth of the same instants: the vectors have equal lengths.
struct Matched {
  std::vector<Pose> estimate;
  std::vector<Pose> truth;
  std::vector<std::size_t> rows;  ///< which poses of the estimate these are
  std::size_t unmatched = 0;      ///< poses of the estimate at whose time the truth is unknown
};

/// Truth this far beyond its first or last pose is still taken, along the motion of its end: file
/// formats round times, and a turn's last firing is not the same instant for everyone.
inline constexpr std::int64_t kMaxExtrapolation_ns = 5'000'000;

/// The pose at a time, interpolated; none where the trajectory does not reach.
std::optional<Pose> pose_at(const std::vector<StampedPose>& poses, std::int64_t stamp_ns);

/// By time where both know times: the truth is interpolated (rotation at constant angular velocity,
/// which is slerp; position linearly). By row else; then both must have as many poses.
/// Throws std::runtime_error when fewer than two poses match.
Matched associate(const Trajectory& estimate, const Trajectory& truth);

}  // namespace lilo
