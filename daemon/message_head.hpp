// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/json_writer.hpp"

#include <cstdint>
#include <string_view>

namespace lilo {

/// Version of the protocol, PROTOCOL.md. Minor: something was added. Major: something changed.
inline constexpr const char* kProtocolVersion = "2.0";

/// Begins a datagram in `out` with what all datagrams of PROTOCOL.md have in common.
/// `stamp_ns`: UTC.
inline void begin_message(JsonWriter& out, std::int64_t stamp_ns, std::string_view session) {
  out = JsonWriter();
  out.text("v", kProtocolVersion);
  out.seconds("timestamp", stamp_ns);
  out.text("session", session);
}

}  // namespace lilo
