// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/trajectory.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lilo {

/// What `lilo listen` shows and `lilo eval` judges of one pose datagram of lilod.
struct PoseMessage {
  std::uint64_t seq = 0;
  std::string session;
  std::string status;
  StampedPose pose;

  std::optional<Matrix6d> covariance;  ///< as in daemon/PROTOCOL.md; nothing: it did not say

  /// 1 sigma of the position and of the rotation, each the root of its block's trace.
  struct Deviation {
    double position_m = 0.0, rotation_rad = 0.0;
  };
  std::optional<Deviation> deviation;  ///< nothing: the daemon did not say

  struct Weak {
    int axis = 0;  ///< the direction's largest component: x y z rx ry rz
    double from_scan = 0.0;
  };
  std::vector<Weak> weak;  ///< the weakest first
};

enum class MessageKind : std::uint8_t { pose, other, other_version, malformed };

/// `other`: a JSON object without a pose (health, hello); whoever listens ignores what it does not
/// know. `other_version`: of another major version of the protocol, where the same names may mean
/// something else. `malformed`: no JSON object, or a pose without its numbers. `message` is
/// untouched unless it is a pose.
MessageKind parse_message(std::string_view datagram, PoseMessage& message);

/// Rotations about fixed x, then y, then z (REP-103), in degrees.
Eigen::Vector3d roll_pitch_yaw_deg(const Eigen::Quaterniond& rotation);
/// To three decimals, and never "-0.000".
double rounded(double value);

/// Two heading lines for pose_line().
std::string pose_heading();
/// One aligned line: time of day (UTC), seq, status, position, roll pitch yaw in degrees, 1 sigma
/// of both, and the weak directions.
std::string pose_line(const PoseMessage& message);

/// One line for any other datagram: the gist of a health report, the datagram itself else. Control
/// characters of what came are question marks, in pose_line() too.
std::string other_line(std::string_view datagram);

}  // namespace lilo
