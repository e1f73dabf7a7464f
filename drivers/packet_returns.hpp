// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/scan.hpp"
#include "drivers/azimuth.hpp"
#include "drivers/lasers.hpp"
#include "drivers/packet_layout.hpp"
#include "drivers/sensor_config.hpp"
#include "drivers/sensor_table.hpp"

#include <cstddef>
#include <cstdint>

namespace lilo {

/// A packet and all that its returns are computed from. What is pointed to must outlive it.
struct PacketContents {
  const std::byte* bytes = nullptr;
  PacketLayout layout;
  const SensorTable* table = nullptr;
  const FiringTimes* times = nullptr;  ///< null: not known
  const AzimuthTable* azimuths = nullptr;
  ReturnChoice choice = ReturnChoice::both;
  Lasers lasers{};
  LaserAngles angles{};
};

/// Adds the returns of one column, in firing order; `t_ns` is the time of its first firing. All
/// pointers of `packet` must be set.
///
/// With azimuth a (clockwise) of a laser, elevation w and distance r, and the height z0 of the
/// beam's origin:
///   x = r cos w cos a,  y = -r cos w sin a,  z = r sin w + z0,
/// where a is the head's azimuth at the firing less the laser's rotational correction. A
/// calibration with distance corrections or origins beside the axis (HDL-64E) adds, with h and v
/// the offsets:
///   x = d_y cos w cos a + h sin a,  y = -(d_x cos w sin a - h cos a),  z = d_m sin w + v.
/// d_x and d_y carry the near-range corrections, linear between 2.40 m (x) or 1.93 m (y) and
/// 25.04 m, where they meet the far one; d_m is their mean, since the manual's choice of d_y alone
/// bends z with the azimuth.
void append_column(const PacketContents& packet, std::size_t column, std::int32_t t_ns,
                   Returns& out);

}  // namespace lilo
