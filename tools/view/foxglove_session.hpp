// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/view/foxglove_messages.hpp"
#include "tools/view/stream_log.hpp"

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <string_view>

namespace lilo::view {

/// The subprotocol to agree on of those a client offers ("a, b"); empty: none of ours.
std::string foxglove_protocol(std::string_view offered);

/// The server's side of the Foxglove WebSocket protocol, version 1: pose, transforms, points and
/// health as JSON channels with Foxglove's own schemas. What came before the client subscribed is
/// not sent. One thread.
class FoxgloveSession {
 public:
  explicit FoxgloveSession(const StreamLog& log);

  /// A text message of the client; what is not understood is left alone.
  void take(std::string_view text);
  /// The next message for it, if there is one.
  bool next(std::string& message, bool& is_binary);

 private:
  struct Message {
    std::string text;
    bool is_binary = false;
  };
  void take_line(const StreamLog::Line& line);
  void take_pose(const nlohmann::json& message);
  void take_points(const nlohmann::json& message);
  void send(FoxgloveChannel channel, const nlohmann::json& payload);

  const StreamLog& log_;
  std::uint64_t position_;
  std::map<std::uint32_t, FoxgloveChannel> channel_of_;  // by subscription
  FoxglovePoints scan_, map_;
  nlohmann::json last_pose_;   // the datagram: points are told in its frame, at its time
  std::int64_t stamp_ns_ = 0;  // of what is being sent
  std::deque<Message> waiting_;
};

}  // namespace lilo::view
