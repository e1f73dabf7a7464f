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

/// Whether the first character of a file that is not blank begins a JSON object. Throws
/// std::runtime_error when the file cannot be read.
bool is_pose_stream(const std::string& path);

/// Reads what `lilo run --poses` writes, or recorded datagrams of daemon/PROTOCOL.md: one a line.
/// Those that are no pose are left out, as are empty lines. Times must grow. Throws
/// std::runtime_error, one line, "file:line: ...".
PoseStream read_pose_stream(const std::string& path);

/// The poses alone.
Trajectory trajectory(const PoseStream& stream);

}  // namespace lilo
