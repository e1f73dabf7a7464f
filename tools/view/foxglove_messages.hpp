// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lilo::view {

/// What a Foxglove client can subscribe to.
enum class FoxgloveChannel : std::uint32_t { pose = 1, transforms, scan, map, health, datagram };

/// The "advertise" message: all channels, with Foxglove's names of their schemas.
std::string foxglove_advertisement();

/// Of a pose datagram of daemon/PROTOCOL.md: foxglove.PoseInFrame, foxglove.FrameTransforms.
nlohmann::json foxglove_pose(const nlohmann::json& pose);
nlohmann::json foxglove_transforms(const nlohmann::json& pose);

/// Gathers the points of a scan from its datagrams.
class FoxglovePoints {
 public:
  /// Adds a points datagram. True with the last one of its scan: cloud() has what came of it. Of a
  /// scan whose last one was lost nothing is shown.
  bool add(const nlohmann::json& message);
  /// foxglove.PointCloud of what was gathered, in that frame at that time.
  [[nodiscard]] nlohmann::json cloud(const nlohmann::json& stamp,
                                     const nlohmann::json& frame_id) const;

 private:
  std::vector<float> xyz_m_;
  std::uint64_t seq_ = 0;
};

/// A binary message of the protocol: data of a subscription.
std::string foxglove_message(std::uint32_t subscription, std::int64_t stamp_ns,
                             std::string_view payload);

}  // namespace lilo::view
