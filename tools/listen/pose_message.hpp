#pragma once

#include "tools/trajectory.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lilo {

/// What `lilo listen` shows of one pose datagram of lilod.
struct PoseMessage {
  std::uint64_t seq = 0;
  std::string session;
  std::string status;
  StampedPose pose;
};

enum class MessageKind : std::uint8_t { pose, other, malformed };

/// `other`: a JSON object without a pose (health, hello); whoever listens ignores what it does not
/// know. `malformed`: no JSON object, or a pose without its numbers; `message` is then untouched.
MessageKind parse_message(std::string_view datagram, PoseMessage& message);

/// Two heading lines for pose_line().
std::string pose_heading();
/// One aligned line: time of day (UTC), seq, status, position, roll pitch yaw in degrees.
std::string pose_line(const PoseMessage& message);

/// One line for any other datagram: the gist of a health report, the datagram itself else.
std::string other_line(std::string_view datagram);

}  // namespace lilo
