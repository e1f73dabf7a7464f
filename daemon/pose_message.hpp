// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/json_writer.hpp"
#include "daemon/pipeline.hpp"

#include <string>
#include <string_view>

namespace lilo {

const char* to_string(TrackingStatus status);

/// Sixteen hexadecimal digits: a gap in seq within one session is a loss, a new session has another
/// origin.
std::string new_session();
/// The same in place: the publisher allocates nothing when a map is given up.
void renew_session(std::string& session);

/// What all pose datagrams of a session have in common.
struct PoseMessageContext {
  std::string session;
  std::string frame_id;
  std::string child_frame_id;
};

/// The pose datagram of PROTOCOL.md, in `out`'s buffer. Empty when there is none: a number every
/// client relies on is not finite. Leaves the covariance out rather than outgrow the datagram.
std::string_view write_pose(const PoseMessageContext& context, const PoseReport& report,
                            std::int64_t now_ns, JsonWriter& out);

}  // namespace lilo
