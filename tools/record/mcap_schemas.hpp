// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace lilo {

/// JSON Schemas for MCAP channels, without `$ref`, which Foxglove does not follow.

/// Of lilod's datagrams of one kind ("pose", "health"): daemon/protocol.schema.json cut down to it.
std::string datagram_schema(const std::string& kind);
/// Of Foxglove's PoseInFrame and FrameTransform, as far as we fill them in.
std::string pose_in_frame_schema();
std::string frame_transform_schema();

/// daemon/protocol.schema.json as text, built in.
extern const char* const kProtocolSchema;

}  // namespace lilo
