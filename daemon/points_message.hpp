// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/json_writer.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace lilo {

/// What the points of a datagram are.
enum class PointSet : std::uint8_t {
  scan,  ///< what the pose was aligned by
  map,   ///< what the scan added to the map
};

/// The pose that points go with: they are told in its child frame, at its instant.
struct PointsContext {
  std::string_view session;
  std::int64_t stamp_ns = 0;  ///< UTC
  std::uint64_t seq = 0;
};

/// Points are sent in whole steps of this, 16 bits an axis: what is farther away than 327 m on one
/// of them is left out.
inline constexpr double kPointResolution_m = 0.01;
inline constexpr std::size_t kPointsPerDatagram = 120;

/// Datagrams that so many points take.
constexpr std::size_t points_datagrams(std::size_t points) {
  return (points + kPointsPerDatagram - 1) / kPointsPerDatagram;
}

/// Datagram `index` of the points_datagrams(all_m.size()) of PROTOCOL.md, in `out`'s buffer. No
/// allocation.
std::string_view write_points(const PointsContext& context, PointSet set,
                              std::span<const Eigen::Vector3f> all_m, std::size_t index,
                              JsonWriter& out);

}  // namespace lilo
