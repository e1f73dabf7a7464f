// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/record/mcap_writer.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>
#include <string_view>

namespace lilo {

/// What a daemon sends as an MCAP file: its datagrams as they are on /lilod/pose and /lilod/health,
/// and, for the 3D panel of Foxglove, poses that are valid (tracking, degraded) as
/// foxglove.PoseInFrame on /odom and foxglove.FrameTransform on /tf.
class McapFile {
 public:
  /// Throws std::runtime_error.
  explicit McapFile(const std::string& path);

  /// `message` is the datagram, parsed. Kinds it does not know are left out.
  void take(std::string_view datagram, const nlohmann::json& message, std::int64_t received_ns);
  void finish() { writer_.finish(); }

 private:
  mcap::Writer writer_;
  std::uint16_t pose_, health_, odom_, transform_;
};

}  // namespace lilo
