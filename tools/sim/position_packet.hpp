// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/sim/packet.hpp"

namespace lilo::sim {

/// The 512-byte position packet (manual, p. 60) of a sensor with a GPS receiver: stamp, PPS state
/// "locked" and the last GPRMC sentence, which a receiver sends 150 ms after its second.
Packet encode_position(std::int64_t time_ns, std::int64_t start_utc_ns, std::uint32_t stamp_us);

/// The sensor sends one about every 14 data packets.
inline constexpr std::int64_t kPositionPeriod_ns = 18'579'456;

}  // namespace lilo::sim
