// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/pose.hpp"
#include "daemon/extras.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace lilo {

inline constexpr std::size_t kMaxRequestBytes = 512;

enum class RequestKind : std::uint8_t { subscribe, unsubscribe, query, reset, save };

/// What can be saved into the state directory.
enum class SaveKind : std::uint8_t { map, trajectory };

/// What a client asks for. See PROTOCOL.md.
struct Request {
  RequestKind kind = RequestKind::query;
  std::string token;               ///< empty: none
  std::optional<double> ttl_s;     ///< subscribe
  Extras wants;                    ///< subscribe
  std::string query;               ///< query: "hello", "pose" or "health"
  std::optional<Pose> start_pose;  ///< reset
  SaveKind save = SaveKind::map;   ///< save
};

/// Either the request, or why it is none, in one line for the client.
struct ParsedRequest {
  std::optional<Request> request;
  std::string error;
};

/// Never throws, whatever the bytes are.
ParsedRequest parse_request(std::string_view datagram);

}  // namespace lilo
