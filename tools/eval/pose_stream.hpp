// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/estimate.hpp"
#include "tools/trajectory.hpp"

#include <optional>
#include <string>
#include <vector>

namespace lilo {

/// A pose and what its sender says of it.
struct SaidPose {
  StampedPose pose;
  TrackingStatus status = TrackingStatus::initializing;
  int session = 0;  ///< counted from 0; poses of different sessions have different origins
  std::optional<Matrix6d> covariance;  ///< x y z rx ry rz (m, rad), in the frame of the pose
};

/// The poses that lilod sends, in the order they were sent.
struct PoseStream {
  std::string name;  ///< the file, for messages
  std::vector<SaidPose> poses;
};

/// Whether a file is called *.mcap, or its first character that is not blank begins a JSON object.
/// Throws std::runtime_error when the file cannot be read.
bool is_pose_stream(const std::string& path);

/// Reads what `lilo run --poses` and `lilo record` write, datagrams of daemon/PROTOCOL.md: one a
/// line, or one a message of an MCAP file. Those that are no pose are left out, as are empty lines
/// and other topics. Times must grow. Throws std::runtime_error, one line, "file:line: ..."; the
/// messages of an MCAP file are counted instead of its lines.
PoseStream read_pose_stream(const std::string& path);

/// The poses alone.
Trajectory trajectory(const PoseStream& stream);

}  // namespace lilo
